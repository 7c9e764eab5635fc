# A press as a machine measures it, of known truth: the forces of a continuum press (response.csv of
# `fingertip reference`) behind a rig, each with a normal error.
#   awk -v seed=1 -v about="obstacle.shape = \"sphere\"|obstacle.radius = \"5 mm\"" -f make_data.awk RUN/response.csv
# The machine touches at 0.28 mm and gives way by 0.1 mm/N. More of it by -v:
#   noise=0.01    error of a force over that force
#   scale=1       of this specimen's forces, as of a finger that is mounted anew
#   branch=0      share of the rubber's stiffness that fades with `constant` [s]: then the finger is indented by
#                 1 mm/s and goes back as quickly, rows have times, and forces are Lee and Radok's
function normal() { return sqrt(-2 * log(1 - rand())) * cos(2 * 3.14159265358979 * rand()) }
function row(depth, force, time,  sigma, told, when) {
  sigma = noise * force
  told = sigma > 0 ? sigma : noise * largest / 100
  when = branch > 0 ? sprintf(",%.4g", time) : ""
  printf "%.6g,%.6g,%.4g%s\n", 0.28 + 1000 * depth + 0.1 * force, force + sigma * normal(), told, when
}
BEGIN {
  FS = ","
  srand(seed)
  if (noise == "") noise = 0.01
  if (scale == "") scale = 1
  printf "# Synthetic: continuum of law A, E = 200 kPa, nu = 0.45, solid finger, normal errors of %g %%\n", 100 * noise
  if (scale != 1) printf "# forces times %g\n", scale
  if (branch > 0) printf "# a share of %g of the stiffness fades with %g s; 1 mm/s there and back\n", branch, constant
  count = split(about, lines, "|")
  for (i = 1; i <= count; ++i) print "# " lines[i]
  print "position [mm],force [N],sigma [N]" (branch > 0 ? ",time [s]" : "")
}
NR > 1 {
  depth[++rows] = $1
  elastic[rows] = scale * $2
}
END {
  largest = elastic[rows]
  steps = branch > 0 ? 2 * rows - 1 : rows
  for (i = 1; i <= steps; ++i) {
    k = i <= rows ? i : 2 * rows - i
    step = 1000 * (depth[k] > before ? depth[k] - before : before - depth[k])  # [s] at 1 mm/s
    time += step
    if (branch > 0) {
      fade = exp(-step / constant)
      alive = alive * fade + (elastic[k] - last) * (1 - fade) * constant / step
    }
    force = (1 - branch) * elastic[k] + branch * alive
    row(depth[k], force > 0 ? force : 0, time)
    before = depth[k]
    last = elastic[k]
  }
}
