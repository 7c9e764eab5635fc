# Tests of damping with normal errors, from formulas: retardation time 2 ms.
#   awk -v seed=1 -v test=creep -f make_data.awk > creep.csv
# test: loss_factor, creep. The files here were made by mawk 1.3.4 with seed 1.
function normal() { return sqrt(-2 * log(1 - rand())) * cos(2 * pi * rand()) }
function row(x, y, sigma) { printf "%.6g,%.6g,%.4g\n", x, y + sigma * normal(), sigma }
BEGIN {
  srand(seed)
  pi = 3.14159265358979
  tau = 2e-3
  print "# Synthetic, " test ": formulas of make_data.awk with normal errors"
  if (test == "loss_factor") {
    print "frequency [Hz],loss_factor [1],sigma [1]"
    for (f = 2; f <= 20; f += 2) row(f, 2 * pi * f * tau, 0.02 * 2 * pi * f * tau)
  }
  if (test == "creep") {
    print "time [ms],creep [1],sigma [1]"
    for (i = 1; i <= 15; i++) row(0.6 * i, 1 - exp(-6e-4 * i / tau), 0.01)
  }
}
