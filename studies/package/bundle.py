#!/usr/bin/env python3
"""Makes what runs without root and compiler, from programs that are built: bundle.py BUILD portable|wheel.

Both hold the programs with the libraries that they load, in lib/fingertip, where the programs look for them and what
these need; only libc and the compiler's own libraries are the system's. Licences of what is bundled lie in
share/doc/fingertip/licences.
"""

import base64
import hashlib
import lzma
import os
import re
import shutil
import subprocess
import sys
import sysconfig
import tarfile
import zipfile
from pathlib import Path

SYSTEM = re.compile(r"/(ld-linux[^/]*|lib(c|m|dl|rt|pthread|resolv|util|gcc_s|stdc\+\+))\.so")
LIBRARIES = Path("lib/fingertip")


def output(*words):
    return subprocess.run(words, check=True, stdout=subprocess.PIPE, text=True).stdout


def is_elf(file):
    with open(file, "rb") as content:
        return content.read(4) == b"\x7fELF"


def loaded_by(file):
    """What the loader finds for it: name wanted -> file; None where it finds nothing."""
    found = {}
    for line in output("ldd", file).splitlines():
        if match := re.match(r"\s*(\S+) => (/\S+|not found)", line):
            found[match[1]] = None if match[2] == "not found" else match[2]
    return found


def foreign(libraries):
    return {name: file for name, file in libraries.items() if not SYSTEM.search(file)}


class Bundle:
    def __init__(self, build, prefix):
        self.prefix = prefix
        self.packages = set()
        shutil.rmtree(prefix, ignore_errors=True)
        output("cmake", "--install", build, "--component", "programs", "--prefix", prefix, "--strip")
        self.module = prefix / "lib/python3/dist-packages/fingertip"
        self.libraries = {}
        for file in self.elves():
            self.libraries |= foreign(loaded_by(file))
        self.add_programs()
        self.add_openmpi()
        for name, file in self.libraries.items():
            self.copy(file, LIBRARIES / name)
        self.add_data()
        self.add_licences()

    def elves(self):
        return [file for file in self.prefix.rglob("*") if file.is_file() and not file.is_symlink() and is_elf(file)]

    def copy(self, source, place):
        """Whose licence is that of the Debian package which it is from."""
        real = os.path.realpath(source)
        target = self.prefix / place
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(real, target)
        target.chmod(target.stat().st_mode | 0o200)
        for path in dict.fromkeys((real, re.sub("^/usr/", "/", real), str(source))):
            owner = subprocess.run(["dpkg", "-S", path], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
            if owner.returncode == 0:
                self.packages.add(owner.stdout.split(":")[0])
                return
        sys.exit(f"bundle.py: no Debian package has {real}, whose licence must be told")

    def add_programs(self):
        """What fingertip starts: it looks here before it looks at the PATH."""
        for name in "gnuplot", "zip":
            program = shutil.which(name) or sys.exit(f"bundle.py: {name} is not there; install it")
            self.libraries |= foreign(loaded_by(os.path.realpath(program)))
            self.copy(program, LIBRARIES / "bin" / name)

    def add_openmpi(self):
        """Its components, which before version 5 it loads while it runs; not those of networks that one machine has not.
        """
        for component in sorted(Path("/usr/lib").glob("*/openmpi/lib/openmpi*/mca_*.so")):
            wanted = loaded_by(component)
            if None in wanted.values():
                continue
            further = {name: file for name, file in foreign(wanted).items() if name not in self.libraries}
            if all(name.startswith("libmca_common_o") for name in further):
                self.libraries |= further
                self.copy(component, LIBRARIES / "openmpi" / component.name)

    def add_data(self):
        for script in "three.min.js", "examples/js/controls/OrbitControls.js":
            self.copy(f"/usr/share/javascript/three/{script}", f"share/fingertip/three/{script}")
        for file in Path("/usr/share/xml/udunits").glob("*.xml"):
            self.copy(file, f"share/fingertip/udunits/{file.name}")

    def add_licences(self):
        for package in sorted(self.packages):
            target = self.prefix / "share/doc/fingertip/licences" / package
            target.parent.mkdir(exist_ok=True)
            shutil.copy2(f"/usr/share/doc/{package}/copyright", target)

    def find_by_origin(self):
        """Says in programs and modules where their libraries are, relative to themselves: an RPATH holds for the
        libraries of a library, too, so only those that have a place of their own are told. Returns the libc needed.
        """
        libc = 0
        for file in self.elves():
            head = output("objdump", "-p", file)
            libc = max([libc, *map(int, re.findall(r"GLIBC_2\.(\d+)", head))])
            told = re.search(r"R(UN)?PATH\s+(.*)", head)
            if (told and told[2] == "$ORIGIN") or (not told and file.name in self.libraries):
                continue
            way = os.path.relpath(self.prefix / LIBRARIES, file.parent)
            output("patchelf", "--force-rpath", "--set-rpath", f"$ORIGIN/{way}", file)
        return libc


def nobodys(entry):
    entry.uid = entry.gid = 0
    entry.uname = entry.gname = "root"
    return entry


def write_archive(build, version):
    name = f"fingertip-{version}"
    folder = build / "package/portable" / name
    bundle = Bundle(build, folder)
    shutil.move(bundle.module, folder / "python/fingertip")
    shutil.rmtree(folder / "lib/python3")
    bundle.find_by_origin()
    target = build / f"package/{name}-x86_64.tar.xz"
    # Machine code packs by a tenth better where calls are made absolute before.
    filters = [{"id": lzma.FILTER_X86}, {"id": lzma.FILTER_LZMA2, "preset": 9}]
    with lzma.open(target, "wb", filters=filters) as packed, tarfile.open(fileobj=packed, mode="w|") as tar:
        tar.add(folder, name, filter=nobodys)
    shutil.rmtree(folder.parent)
    return target


def write_wheel(build, version):
    """The module's package holds the programs: `bin` above the extension is where it looks for them."""
    folder = build / "package/wheel"
    shutil.rmtree(folder, ignore_errors=True)
    bundle = Bundle(build, folder / "fingertip")
    for file in bundle.module.iterdir():
        shutil.move(file, bundle.prefix / file.name)
    shutil.rmtree(bundle.prefix / "lib/python3")
    libc = bundle.find_by_origin()
    python = "cp" + sysconfig.get_config_var("py_version_nodot")
    tag = f"{python}-{python}-manylinux_2_{libc}_x86_64"
    facts = folder / f"fingertip-{version}.dist-info"
    facts.mkdir()
    (facts / "METADATA").write_text(
        f"Metadata-Version: 2.1\nName: fingertip\nVersion: {version}\nLicense: GPL-3.0-or-later\n"
        "Summary: Soft fingertips: mass-spring lattice against continuum\nRequires-Dist: numpy\n"
        f"Requires-Python: =={sysconfig.get_python_version()}.*\n")
    (facts / "WHEEL").write_text(f"Wheel-Version: 1.0\nGenerator: fingertip\nRoot-Is-Purelib: false\nTag: {tag}\n")
    (facts / "entry_points.txt").write_text("[console_scripts]\nfingertip = fingertip.__main__:main\n")
    target = build / f"package/fingertip-{version}-{tag}.whl"
    record = facts / "RECORD"
    with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as wheel:
        lines = []
        for file in sorted(folder.rglob("*")):
            if file.is_dir() or file == record:
                continue
            place = file.relative_to(folder).as_posix()
            content = file.read_bytes()
            digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
            lines.append(f"{place},sha256={digest},{len(content)}\n")
            wheel.write(file, place)
        wheel.writestr(record.relative_to(folder).as_posix(),
                       "".join(lines) + f"{record.relative_to(folder).as_posix()},,\n")
    shutil.rmtree(folder)
    return target


def main():
    build, kind = Path(sys.argv[1]).resolve(), sys.argv[2]
    cache = (build / "CMakeCache.txt").read_text()
    version = re.search(r"^CMAKE_PROJECT_VERSION:STATIC=(.*)$", cache, re.M)[1]
    (build / "package").mkdir(exist_ok=True)
    print({"portable": write_archive, "wheel": write_wheel}[kind](build, version))


if __name__ == "__main__":
    main()
