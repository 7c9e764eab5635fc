# A press as a machine measures it, of known truth: the forces of a continuum press (response.csv of
# `fingertip reference`) behind a rig, each with a normal error of 1 % of itself.
#   awk -v seed=1 -v about="obstacle.shape = \"sphere\"|obstacle.radius = \"5 mm\"" -f make_data.awk RUN/response.csv
# The machine touches at 0.28 mm and gives way by 0.1 mm/N.
function normal() { return sqrt(-2 * log(1 - rand())) * cos(2 * 3.14159265358979 * rand()) }
BEGIN {
  FS = ","
  srand(seed)
  print "# Synthetic: continuum of law A, E = 200 kPa, nu = 0.45, solid finger, normal errors of 1 %"
  count = split(about, lines, "|")
  for (i = 1; i <= count; ++i) print "# " lines[i]
  print "position [mm],force [N],sigma [N]"
}
NR > 1 {
  force = $2
  sigma = 0.01 * force
  printf "%.6g,%.6g,%.4g\n", 0.28 + 1000 * $1 + 0.1 * force, force + sigma * normal(), sigma
}
