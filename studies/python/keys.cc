#include "studies/python/keys.h"

#include <pybind11/stl.h>

#include "studies/config/keys/key_table.h"

namespace fingertip::studies::inline python {

namespace py = pybind11;

namespace {

py::dict told(const Key& key) {
  py::list choices;
  for (const Choice& choice : key.choices)
    choices.append(py::make_tuple(choice.word, choice.meaning));
  py::dict entry;
  entry["name"] = key.full_name();
  entry["kind"] = name(key.kind);
  entry["default"] = key.preset;
  entry["unit"] = key.unit;
  entry["help"] = key.help;
  entry["allowed"] = key.allowed();
  entry["rule"] = key.rule;
  entry["choices"] = choices;
  return entry;
}

}  // namespace

void add_keys(py::module_& module) {
  module.def(
      "keys",
      [] {
        py::list all;
        for (const Key& key : key_table()) all.append(told(key));
        return all;
      },
      "Every key of the configuration: name, kind, default, unit, help, allowed, rule, choices.");
  module.def(
      "sections",
      [] {
        py::dict all;
        for (const Section& section : sections()) all[py::str(section.name)] = section.help;
        return all;
      },
      "The sections of the configuration and what they are about.");
}

}  // namespace fingertip::studies::inline python
