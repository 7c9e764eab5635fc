# Material tests of known truth with normal errors, from formulas: E = 40, G = 14 gf/cm^2 of law A,
# retardation time 2 ms.
#   awk -v seed=1 -v test=uniaxial -f make_data.awk > uniaxial.csv
# test: uniaxial, shear, loss_factor, creep. The files here were made by mawk 1.3.4 with seed 1.
function normal() { return sqrt(-2 * log(1 - rand())) * cos(2 * pi * rand()) }
function row(x, y, sigma) { printf "%.6g,%.6g,%.4g\n", x, y + sigma * normal(), sigma }
# Law A: the sides of a stretched bar are free where G (t^2 - 1) + lambda ln(s t^2) = 0.
function across(s,   low, high, t) {
  low = 0.01; high = 10
  while (high - low > 1e-14) {
    t = (low + high) / 2
    if (G * (t * t - 1) + lambda * log(s * t * t) > 0) high = t; else low = t
  }
  return (low + high) / 2
}
BEGIN {
  srand(seed)
  pi = 3.14159265358979
  G = 14 * 98.0665; E = 40 * 98.0665; lambda = G * (E - 2 * G) / (3 * G - E); tau = 2e-3
  print "# Synthetic, " test ": formulas of make_data.awk with normal errors"
  if (test == "uniaxial") {
    print "stretch [1],nominal_stress [Pa],sigma [Pa]"
    for (i = -6; i <= 12; i++) if (i != 0) {
      s = 1 + 0.05 * i; t = across(s)
      row(s, G * (s - t * t / s), 10)
    }
  }
  if (test == "shear") {
    print "shear [1],shear_stress [Pa],sigma [Pa]"
    for (i = 1; i <= 12; i++) row(0.05 * i, G * 0.05 * i, 10)
  }
  if (test == "loss_factor") {
    print "frequency [Hz],loss_factor [1],sigma [1]"
    for (f = 2; f <= 20; f += 2) row(f, 2 * pi * f * tau, 0.02 * 2 * pi * f * tau)
  }
  if (test == "creep") {
    print "time [ms],creep [1],sigma [1]"
    for (i = 1; i <= 15; i++) row(0.6 * i, 1 - exp(-6e-4 * i / tau), 0.01)
  }
}
