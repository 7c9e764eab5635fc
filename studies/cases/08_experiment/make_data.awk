# Two measured curves of known truth: the forces of two continuum presses (response.csv of
# `fingertip reference`), each with a normal error of 1 % of itself.
#   awk -v seed=1 -v contact=frictionless -f make_data.awk RUN/response.csv > frictionless.csv
# The files here were made by mawk 1.3.4 with seed 1 (frictionless) and 2 (stick) from
#   ./fingertip reference --set press.contact=CONTACT --set 'press.samples=["0.02 cm", ... "0.12 cm"]'
#     --set reference.tolerance=0.002
# and shallow.csv with seed 3 from ten frictionless samples to 0.05 cm.
function normal() { return sqrt(-2 * log(1 - rand())) * cos(2 * 3.14159265358979 * rand()) }
BEGIN {
  FS = ","
  srand(seed)
  print "# Synthetic: linear continuum of E = 40, G = 14 gf/cm^2, default finger, normal errors of 1 %"
  print "# press.contact = \"" contact "\""
  print "indentation [mm],force [mN],sigma [mN]"
}
NR > 1 {
  force = 1000 * $2
  sigma = 0.01 * force
  printf "%.4g,%.6g,%.4g\n", 1000 * $1, force + sigma * normal(), sigma
}
