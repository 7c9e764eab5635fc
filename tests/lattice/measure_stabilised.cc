// Prints what damping costs by a stabilised explicit method, Runge-Kutta-Chebyshev of second order
// (RKC; Sommeijer, Shampine & Verwer, J. Comput. Appl. Math. 88 (1998) 315-326), beside symplectic
// Euler at its largest step: force evaluations and processor time per millisecond of free rubber,
// network, tau = 0.3 ms, one thread. The number of stages is the one that needs fewest evaluations;
// that such a step is stable, and one a tenth longer is not, is tried
// (lattice/dynamics/integrators; lattice/MEASUREMENTS.md quotes it).
#include <array>
#include <cmath>
#include <complex>
#include <cstdio>
#include <ctime>
#include <random>
#include <vector>

#include "lattice/dynamics/spectrum.h"
#include "lattice/dynamics/time_step.h"
#include "lattice/forces/forces.h"
#include "tests/lattice/fixtures.h"

using namespace fingertip;
using namespace fixtures;
using lattice::LatticeModel;
using lattice::State;
using lattice::VectorField;

namespace {

constexpr double retardation_time = 3e-4;  // [s]

// y_j = (1 - mu - nu) y_0 + mu y_(j-1) + nu y_(j-2) + h (slope f_(j-1) + first f_0).
struct Stage {
  double mu = 0.0, nu = 0.0, slope = 0.0, first = 0.0;
};

// `damping` widens the region of stability along the real axis and shortens it.
std::vector<Stage> stages_of(int count, double damping) {
  const std::size_t s = std::size_t(count);
  const double w0 = 1.0 + damping / double(count * count);
  std::vector<double> T{1.0, w0}, first{0.0, 1.0}, second{0.0, 0.0};  // Chebyshev, derivatives
  for (std::size_t j = 2; j <= s; ++j) {
    T.push_back(2.0 * w0 * T[j - 1] - T[j - 2]);
    first.push_back(2.0 * w0 * first[j - 1] - first[j - 2] + 2.0 * T[j - 1]);
    second.push_back(2.0 * w0 * second[j - 1] - second[j - 2] + 4.0 * first[j - 1]);
  }
  const double w1 = first[s] / second[s];
  std::vector<double> b(s + 1);
  for (std::size_t j = 2; j <= s; ++j) b[j] = second[j] / (first[j] * first[j]);
  b[0] = b[1] = b[2];
  std::vector<Stage> stages{{}, {.slope = b[1] * w1}};
  for (std::size_t j = 2; j <= s; ++j) {
    const double slope = 2.0 * b[j] * w1 / b[j - 1], a = 1.0 - b[j - 1] * T[j - 1];
    stages.push_back({2.0 * b[j] * w0 / b[j - 1], -b[j] / b[j - 2], slope, -a * slope});
  }
  return stages;
}

// |y| after a step of y' = z y/h from 1.
double amplification(const std::vector<Stage>& stages, std::complex<double> z) {
  std::complex<double> before = 1.0, now = 1.0 + stages[1].slope * z;
  for (std::size_t j = 2; j < stages.size(); ++j) {
    const Stage& k = stages[j];
    const auto next =
        (1.0 - k.mu - k.nu) + k.mu * now + k.nu * before + z * (k.slope * now + k.first);
    before = now;
    now = next;
  }
  return std::abs(now);
}

// For every motion y'' + tau l y' + l y = 0 with 0 < l <= largest.
bool stable(const std::vector<Stage>& stages, double step, double largest) {
  constexpr int motions = 1000;
  for (int n = 1; n <= motions; ++n) {
    const double l = largest * std::pow(double(n) / motions, 3.0), c = retardation_time * l;
    const std::complex<double> root = std::sqrt(std::complex<double>(c * c - 4.0 * l));
    for (const auto& rate : {0.5 * (-c + root), 0.5 * (-c - root)})
      if (amplification(stages, step * rate) > 1.0 + 1e-9) return false;
  }
  return true;
}

struct Scheme {
  std::vector<Stage> stages;
  double step = 0.0;                                                               // [s]
  double evaluations() const { return double(stages.size() - 1) / (1e3 * step); }  // per ms
};

Scheme best_scheme(double largest) {
  Scheme best;
  for (const double damping : {2.0 / 13.0, 1.0, 5.0, 20.0}) {
    for (int count = 2; count <= 30; ++count) {
      Scheme tried{stages_of(count, damping)};
      double longest = 5e-3;
      for (int halvings = 0; halvings < 30; ++halvings) {
        const double middle = 0.5 * (tried.step + longest);
        (stable(tried.stages, middle, largest) ? tried.step : longest) = middle;
      }
      if (tried.step > 0.0 && (best.step == 0.0 || tried.evaluations() < best.evaluations()))
        best = tried;
    }
  }
  return best;
}

// Displacements and velocities of the particles, and how they change.
class FreeRubber {
 public:
  explicit FreeRubber(const LatticeModel& model)
      : model_(&model), team_(1), forces_(model, team_), force_(model.points()) {}

  void slopes(const State& state, State& slope) {
    forces_.accumulate(state, force_);
    for (std::size_t c = 0; c < 3; ++c) {
      for (const std::uint32_t b : model_->blocks) {
        for (std::size_t i = b; i < b + lattice::lanes; ++i) {
          slope.displacement.component[c][i] = state.velocity.component[c][i];
          slope.velocity.component[c][i] = model_->inverse_mass[i] * force_.component[c][i];
        }
      }
    }
  }

  // combined = Σ factor state, over at most five states, one of which it may be.
  void combine(const std::array<std::pair<double, const State*>, 5>& terms, State& combined) {
    const auto sum = [&](auto field) {
      for (std::size_t c = 0; c < 3; ++c) {
        double* to = (combined.*field).component[c].data();
        const double* from[5];
        for (std::size_t n = 0; n < 5; ++n) from[n] = (terms[n].second->*field).component[c].data();
        for (const std::uint32_t b : model_->blocks)
          for (std::size_t i = b; i < b + lattice::lanes; ++i)
            to[i] = terms[0].first * from[0][i] + terms[1].first * from[1][i] +
                    terms[2].first * from[2][i] + terms[3].first * from[3][i] +
                    terms[4].first * from[4][i];
      }
    };
    sum(&State::displacement);
    sum(&State::velocity);
  }

 private:
  const LatticeModel* model_;
  lattice::Team team_;
  lattice::InternalForces forces_;
  VectorField force_;
};

// Largest speed after `duration` [s] of small random motion, and the processor time per ms [us].
struct March {
  double speed = 0.0, time = 0.0;
};

double largest_speed(const LatticeModel& model, const State& state) {
  double largest = 0.0;
  for (const std::uint32_t i : model.particles) {
    const double speed = state.velocity.at(i).norm();
    if (!std::isfinite(speed)) return INFINITY;
    largest = std::max(largest, speed);
  }
  return largest;
}

March march_chebyshev(const LatticeModel& model, const Scheme& scheme, double step,
                      double duration) {
  FreeRubber rubber(model);
  State start = random_state(model, 1e-6, 1e-6, 1), before(model), now(model), first(model),
        slope(model);
  const long steps = std::lround(duration / step);
  const std::clock_t begin = std::clock();
  for (long n = 0; n < steps; ++n) {
    rubber.slopes(start, first);
    before = start;
    rubber.combine({{{1.0, &start},
                     {step * scheme.stages[1].slope, &first},
                     {0.0, &first},
                     {0.0, &first},
                     {0.0, &first}}},
                   now);
    for (std::size_t j = 2; j < scheme.stages.size(); ++j) {
      const Stage& k = scheme.stages[j];
      rubber.slopes(now, slope);
      rubber.combine({{{1.0 - k.mu - k.nu, &start},
                       {k.mu, &now},
                       {k.nu, &before},
                       {step * k.slope, &slope},
                       {step * k.first, &first}}},
                     before);
      std::swap(before, now);
    }
    std::swap(start, now);
  }
  const double time = double(std::clock() - begin) / CLOCKS_PER_SEC;
  return {largest_speed(model, start), 1e6 * time / (1e3 * double(steps) * step)};
}

March march_euler(const LatticeModel& model, double step, double duration) {
  FreeRubber rubber(model);
  State state = random_state(model, 1e-6, 1e-6, 1), slope(model);
  const long steps = std::lround(duration / step);
  const std::clock_t begin = std::clock();
  for (long n = 0; n < steps; ++n) {
    rubber.slopes(state, slope);
    for (std::size_t c = 0; c < 3; ++c) {
      double *u = state.displacement.component[c].data(), *v = state.velocity.component[c].data();
      const double* a = slope.velocity.component[c].data();
      for (const std::uint32_t b : model.blocks) {
        for (std::size_t i = b; i < b + lattice::lanes; ++i) {
          v[i] += step * a[i];
          u[i] += step * v[i];
        }
      }
    }
  }
  const double time = double(std::clock() - begin) / CLOCKS_PER_SEC;
  return {largest_speed(model, state), 1e6 * time / (1e3 * double(steps) * step)};
}

void measure(int per_radius) {
  lattice::LatticeSettings settings =
      settings_for(lattice::ModelKind::network, lattice::Kinematics::finite, per_radius);
  meshes::Rubber rubber;
  rubber.retardation_time = retardation_time;
  settings.constants = lattice::hookean_constants(rubber, settings.spacing);
  const LatticeModel model = lattice::build_tip({}, rubber, settings);
  lattice::SpectralBounds bounds = lattice::spectral_estimate(model);
  bounds.stiffness *= 1.02;
  bounds.damping *= 1.02;
  const double euler = lattice::largest_stable_step(bounds, lattice::Integrator::symplectic_euler);
  const Scheme chebyshev = best_scheme(bounds.stiffness);
  const double duration = 0.1;
  const March by_euler = march_euler(model, euler, duration),
              by_chebyshev = march_chebyshev(model, chebyshev, chebyshev.step, duration),
              too_long = march_chebyshev(model, chebyshev, 1.1 * chebyshev.step, duration);
  std::printf("%d,%.1f,%.1f,%.0f,%.2e,%zu,%.0f,%.1f,%.0f,%.2e,%.2e\n", per_radius, 1e6 * euler,
              1e-3 / euler, by_euler.time, by_euler.speed, chebyshev.stages.size() - 1,
              1e6 * chebyshev.step, chebyshev.evaluations(), by_chebyshev.time, by_chebyshev.speed,
              too_long.speed);
}

}  // namespace

int main() {
  std::puts(
      "R/a,symplectic Euler [us],evaluations per ms,us per ms,speed left [m/s],RKC stages,step "
      "[us],evaluations per ms,us per ms,speed left [m/s],of a step a tenth longer [m/s]");
  for (const int per_radius : {8, 12, 16}) measure(per_radius);
}
