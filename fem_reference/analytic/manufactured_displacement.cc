#include "fem_reference/analytic/manufactured_displacement.h"

#include <cmath>
#include <numbers>

namespace fingertip::fem_reference::analytic {
namespace {

using enum Factor::Kind;
using Orders = std::array<int, 3>;

/// v, the compressible part.
constexpr std::array<Product, 3> compressible{{
    {{{sine, 1.3, 0.2}, {exponential, 0.4, 0.0}, {sine, 1.7, 0.5}}},
    {{{exponential, -0.3, 0.0}, {sine, 1.9, 0.4}, {sine, 1.1, 0.9}}},
    {{{sine, 1.5, 0.7}, {sine, 0.8, 1.1}, {exponential, 0.5, 0.0}}},
}};

/// Psi, the vector potential.
constexpr std::array<Product, 3> potential{{
    {{{sine, 0.9, 0.3}, {sine, 1.6, 0.1}, {exponential, -0.4, 0.0}}},
    {{{exponential, 0.35, 0.0}, {sine, 1.2, 0.6}, {sine, 1.4, 0.2}}},
    {{{sine, 1.8, 0.5}, {exponential, -0.25, 0.0}, {sine, 1.0, 0.8}}},
}};

double product_partial(const Product& product, const Orders& orders, const Vector3& x) {
  double result = 1.0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    result *= product[axis].derivative(orders[axis], x[Eigen::Index(axis)]);
  return result;
}

Orders with(Orders orders, int axis) {
  ++orders[std::size_t(axis)];
  return orders;
}

/// Derivative of div v.
double divergence_partial(const Orders& orders, const Vector3& x) {
  double result = 0.0;
  for (int i = 0; i < 3; ++i)
    result += product_partial(compressible[std::size_t(i)], with(orders, i), x);
  return result;
}

}  // namespace

double Factor::derivative(int n, double t) const {
  const double scale = std::pow(rate, n);
  if (kind == exponential) return scale * std::exp(rate * t);
  return scale * std::sin(rate * t + phase + n * std::numbers::pi / 2.0);
}

ManufacturedDisplacement::ManufacturedDisplacement(const meshes::Rubber& rubber, double length,
                                                   double amplitude, Variant variant)
    : rubber_(checked(rubber)),
      length_(checked_positive("length", length)),
      amplitude_(checked_finite("amplitude", amplitude)),
      solenoidal_part_(variant == Variant::nearly_solenoidal),
      compressible_part_(solenoidal_part_
                             ? rubber.shear_modulus / (rubber.lame_lambda() + rubber.shear_modulus)
                             : 1.0) {}

double ManufacturedDisplacement::partial(int i, const Orders& orders, const Vector3& x) const {
  const Vector3 scaled = x / length_;
  double result =
      compressible_part_ * product_partial(compressible[std::size_t(i)], orders, scaled);
  if (solenoidal_part_) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;  // (curl Psi)_i = d_j Psi_k - d_k Psi_j
    result += product_partial(potential[std::size_t(k)], with(orders, j), scaled) -
              product_partial(potential[std::size_t(j)], with(orders, k), scaled);
  }
  return result;
}

Vector3 ManufacturedDisplacement::displacement(const Vector3& x) const {
  Vector3 result;
  for (int i = 0; i < 3; ++i) result[i] = amplitude_ * partial(i, {0, 0, 0}, x);
  return result;
}

Matrix3 ManufacturedDisplacement::gradient(const Vector3& x) const {
  Matrix3 result;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      result(i, j) = amplitude_ / length_ * partial(i, with({0, 0, 0}, j), x);
  return result;
}

double ManufacturedDisplacement::dilatation(const Vector3& x) const {
  return amplitude_ / length_ * compressible_part_ * divergence_partial({0, 0, 0}, x / length_);
}

Matrix3 ManufacturedDisplacement::stress(const Vector3& x) const {
  const Matrix3 g = gradient(x);
  return rubber_.lame_lambda() * dilatation(x) * Matrix3::Identity() +
         rubber_.shear_modulus * (g + g.transpose());
}

Vector3 ManufacturedDisplacement::body_force(const Vector3& x) const {
  const double G = rubber_.shear_modulus;
  Vector3 result;
  for (int i = 0; i < 3; ++i) {
    double laplacian = 0.0;
    for (int j = 0; j < 3; ++j) laplacian += partial(i, with(with({0, 0, 0}, j), j), x);
    const double gradient_of_dilatation =
        compressible_part_ * divergence_partial(with({0, 0, 0}, i), x / length_);
    result[i] = -amplitude_ / (length_ * length_) *
                (G * laplacian + (rubber_.lame_lambda() + G) * gradient_of_dilatation);
  }
  return result;
}

namespace {

/// g and w of u = amplitude (x g, y g, w), lengths over the field's, with the derivatives needed:
/// both are a sine of t times an exponential of s.
struct Revolution {
  explicit Revolution(const Vector3& scaled)
      : s(scaled.head<2>().squaredNorm()),
        g(value(across, scaled.z(), 0)),
        g_t(value(across, scaled.z(), 1)),
        g_tt(value(across, scaled.z(), 2)),
        w(value(along, scaled.z(), 0)),
        w_t(value(along, scaled.z(), 1)),
        w_tt(value(along, scaled.z(), 2)) {}

  struct Shape {
    Factor height;
    double decay;
  };
  static constexpr Shape across{{sine, 1.3, 0.4}, -0.6}, along{{sine, 1.7, 0.2}, 0.5};

  double value(const Shape& shape, double t, int order) const {
    return shape.height.derivative(order, t) * std::exp(shape.decay * s);
  }

  double s, g, g_t, g_tt, w, w_t, w_tt;
};

}  // namespace

ManufacturedRevolution::ManufacturedRevolution(const meshes::Rubber& rubber, double length,
                                               double amplitude)
    : rubber_(checked(rubber)),
      length_(checked_positive("length", length)),
      amplitude_(checked_finite("amplitude", amplitude)) {}

Vector3 ManufacturedRevolution::displacement(const Vector3& x) const {
  const Vector3 p = x / length_;
  const Revolution field(p);
  return amplitude_ * Vector3(p.x() * field.g, p.y() * field.g, field.w);
}

Matrix3 ManufacturedRevolution::gradient(const Vector3& x) const {
  const Vector3 p = x / length_;
  const Revolution field(p);
  const double g_s = Revolution::across.decay * field.g, w_s = Revolution::along.decay * field.w;
  Matrix3 result = Matrix3::Zero();
  for (int i = 0; i < 2; ++i) {
    result(i, i) = field.g;
    for (int j = 0; j < 2; ++j) result(i, j) += 2.0 * g_s * p[i] * p[j];
    result(i, 2) = p[i] * field.g_t;
    result(2, i) = 2.0 * w_s * p[i];
  }
  result(2, 2) = field.w_t;
  return amplitude_ / length_ * result;
}

Matrix3 ManufacturedRevolution::stress(const Vector3& x) const {
  return hooke_stress(rubber_, gradient(x));
}

Vector3 ManufacturedRevolution::body_force(const Vector3& x) const {
  const Vector3 p = x / length_;
  const Revolution field(p);
  const double a = Revolution::across.decay, b = Revolution::along.decay, s = field.s;
  // div u = amplitude/length (g (2 + 2 a s) + w_t), and its derivatives by s and t.
  const double div_s = field.g * (4.0 * a + 2.0 * a * a * s) + b * field.w_t;
  const double div_t = field.g_t * (2.0 + 2.0 * a * s) + field.w_tt;
  // The Laplacian of x g is x (4 s g_ss + 8 g_s + g_tt), of w it is 4 s w_ss + 4 w_s + w_tt.
  const double across = field.g * (4.0 * a * a * s + 8.0 * a) + field.g_tt;
  const double along = field.w * (4.0 * b * b * s + 4.0 * b) + field.w_tt;
  const double G = rubber_.shear_modulus, sum = rubber_.lame_lambda() + G;
  return -amplitude_ / (length_ * length_) *
         Vector3(p.x() * (G * across + 2.0 * sum * div_s), p.y() * (G * across + 2.0 * sum * div_s),
                 G * along + sum * div_t);
}

}  // namespace fingertip::fem_reference::analytic
