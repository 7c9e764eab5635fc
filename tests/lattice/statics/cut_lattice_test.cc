#include "lattice/statics/cut_lattice.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "body_sums.h"
#include "lattice/model/cut_model.h"
#include "meshes/cells/cubic_grid.h"
#include "meshes/cells/surface_points.h"
#include "tests/expectations.h"

using namespace fingertip;
using namespace body_sums;
using lattice::Kinematics;
using lattice::LatticeSettings;
using lattice::ModelKind;
using meshes::Geometry;
using meshes::ProfileSurface;
using meshes::Rubber;

namespace {

LatticeSettings settings_for(ModelKind model, Kinematics kinematics, double spacing) {
  LatticeSettings settings;
  settings.model = model;
  settings.kinematics = kinematics;
  settings.spacing = spacing;
  const Rubber rubber;
  settings.constants =
      lattice::hookean_constants(rubber, spacing, 0.2 * spacing * rubber.shear_modulus);
  return settings;
}

LatticeSettings skew_settings(ModelKind model, Kinematics kinematics, double spacing) {
  LatticeSettings settings = settings_for(model, kinematics, spacing);
  settings.axes = Eigen::AngleAxisd(0.6, Vector3(1.0, 2.0, 3.0).normalized()).toRotationMatrix();
  settings.offset = Vector3(0.3, -0.2, 0.7);
  return settings;
}

/// A displacement gradient without any symmetry, of about this size.
Matrix3d some_gradient(double size) {
  Matrix3d H;
  H << 0.31, -0.72, 0.15, 0.44, -0.26, 0.63, -0.58, 0.09, 0.47;
  return size * H;
}

Matrix3d hookes_stress(const Rubber& rubber, const Matrix3d& H) {
  return rubber.shear_modulus * (H + H.transpose()) +
         rubber.lame_lambda() * H.trace() * Matrix3d::Identity();
}

/// First Piola-Kirchhoff stress of law A.
Matrix3d law_a_stress(const Rubber& rubber, const Matrix3d& H) {
  const Matrix3d F = Matrix3d::Identity() + H, transposed_inverse = F.inverse().transpose();
  return rubber.shear_modulus * (F - transposed_inverse) +
         rubber.lame_lambda() * std::log(F.determinant()) * transposed_inverse;
}

double largest_of(const VectorXd& forces) {
  double largest = 0.0;
  for (Eigen::Index i = 0; i < forces.size(); i += 3) {
    largest = std::max(largest, forces.segment<3>(i).norm());
  }
  return largest;
}

double volume_of(const LatticeBody& body) {
  double sum = 0.0;
  for (const MeanCell& cell : body.cells) sum += cell.volume;
  return sum * body.sectors;
}

double area_of(const std::vector<EmbeddedPoint>& points) {
  double sum = 0.0;
  for (const EmbeddedPoint& point : points) sum += point.area;
  return sum;
}

/// Forces on the particles of a traction `stress` n on the tip's whole boundary, by quadrature with
/// `apart` between points.
VectorXd traction_forces(const LatticeBody& body, const Geometry& geometry,
                         const LatticeSettings& settings, const Matrix3d& stress, double apart) {
  // The grid's directions, whatever their order.
  const auto& corners = body.cells.front().corners;
  Matrix3d axes;
  for (int d = 0; d < 3; ++d) {
    axes.col(d) =
        (body.rest[corners[std::size_t(1 << d)]] - body.rest[corners[0]]) / settings.spacing;
  }
  const auto local = [&](const Vector3& at) {
    return Vector3(axes.transpose() * (at - body.rest.front()) / settings.spacing);
  };
  std::map<std::array<int, 3>, const MeanCell*> cell_at;
  for (const MeanCell& cell : body.cells) {
    const Vector3 at = local(body.rest[cell.corners[0]]).array().round();
    cell_at[{int(at.x()), int(at.y()), int(at.z())}] = &cell;
  }
  VectorXd forces = VectorXd::Zero(body.unknowns());
  for (const ProfileSurface surface :
       {ProfileSurface::contact, ProfileSurface::bond, ProfileSurface::free}) {
    for (const auto& point : meshes::surface_points(geometry, surface, apart)) {
      // A hair inside the rubber, for the end may lie in a plane of the grid.
      const Vector3 at = local(point.position - 1e-6 * settings.spacing * point.normal);
      const Vector3 low = at.array().floor(), xi = at - low;
      const auto found = cell_at.find({int(low.x()), int(low.y()), int(low.z())});
      if (found == cell_at.end()) continue;  // slivers that were left out
      for (int c = 0; c < 8; ++c) {
        double weight = point.area;
        for (int d = 0; d < 3; ++d) weight *= (c >> d & 1) != 0 ? xi[d] : 1.0 - xi[d];
        forces.segment<3>(3 * Eigen::Index(found->second->corners[std::size_t(c)])) +=
            weight * stress * point.normal;
      }
    }
  }
  return forces;
}

/// Largest nodal force that a linear displacement leaves unbalanced, over stress times a².
double patch_residual(const LatticeSettings& settings, const Matrix3d& H, const Matrix3d& stress,
                      double points_per_spacing) {
  const Geometry geometry;
  const LatticeBody body = lattice::build_cut_tip(geometry, {}, settings, 1);
  const VectorXd u = on_particles(body, [&](const Vector3& x) { return Vector3(H * x); });
  const double apart = settings.spacing / points_per_spacing;
  const VectorXd rest =
      fibre_and_cell_forces(body, u) - traction_forces(body, geometry, settings, stress, apart);
  return largest_of(rest) / (stress.norm() * settings.spacing * settings.spacing);
}

/// A field that the planes x = 0 and y = 0 mirror, far from linear; `size` is relative to R.
Vector3 mirrored_field(const Vector3& x, double size) {
  const double R = 0.01, p = x.x() * x.x() / (R * R), q = x.y() * x.y() / (R * R), z = x.z() / R;
  return size * Vector3(x.x() * (1.0 + q - 0.3 * z), x.y() * (0.4 - p * z),
                        R * (0.2 * z * z - p + 0.5 * q));
}

const ModelKind cut_models[] = {ModelKind::central, ModelKind::hookean, ModelKind::network};
const Kinematics both_kinematics[] = {Kinematics::small, Kinematics::finite};

}  // namespace

TEST(CutLattice, PatchTestAtSmallStrain) {
  const Matrix3d H = some_gradient(1e-3), stress = hookes_stress({}, H);
  for (const ModelKind model : {ModelKind::hookean, ModelKind::network}) {
    for (const LatticeSettings& settings : {settings_for(model, Kinematics::small, 0.01 / 6),
                                            skew_settings(model, Kinematics::small, 0.01 / 6)}) {
      const double coarse = patch_residual(settings, H, stress, 10.0);
      const double fine = patch_residual(settings, H, stress, 40.0);
      RecordProperty("residual", std::to_string(coarse) + " " + std::to_string(fine));
      EXPECT_LT(fine, 1e-3) << name(model);
      EXPECT_LT(fine, 0.25 * coarse) << name(model);
    }
  }
}

TEST(CutLattice, PatchTestAtFiniteStrain) {
  const Matrix3d H = some_gradient(0.4), stress = law_a_stress({}, H);
  const auto settings = skew_settings(ModelKind::network, Kinematics::finite, 0.01 / 6);
  const double coarse = patch_residual(settings, H, stress, 10.0);
  const double fine = patch_residual(settings, H, stress, 40.0);
  EXPECT_LT(fine, 1e-3);
  EXPECT_LT(fine, 0.25 * coarse);
}

TEST(CutLattice, NetworkIsFreeOfStressAtRest) {
  for (const LatticeSettings& settings :
       {settings_for(ModelKind::network, Kinematics::finite, 0.01 / 6),
        settings_for(ModelKind::network, Kinematics::finite, 0.000833333),  // slivers at the end
        skew_settings(ModelKind::network, Kinematics::finite, 0.01 / 6)}) {
    const LatticeBody body = lattice::build_cut_tip({}, {}, settings, 1);
    const double scale = Rubber().shear_modulus * settings.spacing * settings.spacing;
    const VectorXd forces = fibre_and_cell_forces(body, VectorXd::Zero(body.unknowns()));
    EXPECT_LT(largest_of(forces), 1e-12 * scale);
    EXPECT_GT(body.fibres.front().stiffness, 0.0);
  }
}

TEST(CutLattice, OnlyRigidMotionIsFree) {
  const auto settings = skew_settings(ModelKind::hookean, Kinematics::small, 0.01 / 4);
  Geometry geometry;
  geometry.sleeve_length = 0.0;
  const LatticeBody body = lattice::build_cut_tip(geometry, {}, settings, 1);
  // Measured against each unknown's own stiffness, since the corners of slivers have next to none.
  Eigen::MatrixXd K = stiffness(body);
  const VectorXd scale = K.diagonal().cwiseSqrt().cwiseInverse();
  K = scale.asDiagonal() * K * scale.asDiagonal();
  const VectorXd values =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(K, Eigen::EigenvaluesOnly).eigenvalues();
  EXPECT_LT(std::abs(values[5]), 1e-12);
  EXPECT_GT(values[6], 1e-5);
}

TEST(CutLattice, VolumeMassAndAreasAreTheTips) {
  Geometry shell, thin;
  shell.sleeve_length = 0.0;
  thin.rod_radius = 0.008;
  const Rubber rubber;
  for (const Geometry& geometry : {Geometry(), shell, thin}) {
    for (const LatticeSettings& settings :
         {settings_for(ModelKind::hookean, Kinematics::small, 0.001),
          skew_settings(ModelKind::central, Kinematics::finite, 0.001)}) {
      const LatticeBody body = lattice::build_cut_tip(geometry, rubber, settings, 1);
      EXPECT_NEAR(volume_of(body) / geometry.tip_volume(), 1.0, 1e-6);
      const double mass = std::accumulate(body.mass.begin(), body.mass.end(), 0.0);
      EXPECT_NEAR(mass / (rubber.density * geometry.tip_volume()), 1.0, 1e-6);
      EXPECT_GT(*std::min_element(body.mass.begin(), body.mass.end()), 0.0);
      EXPECT_NEAR(area_of(body.bond) / meshes::surface_area(geometry, ProfileSurface::bond), 1.0,
                  1e-12);
      // The hemisphere, and of the sleeve what a ring more or less leaves of a depth R - r.
      const double perimeter = 2.0 * 3.14159265358979 * geometry.tip_radius;
      const double reached = std::min(geometry.thickness(), geometry.sleeve_length);
      EXPECT_NEAR(area_of(body.outer), perimeter * (geometry.tip_radius + reached),
                  perimeter * settings.spacing / 3.0);
    }
  }
}

TEST(CutLattice, MassHasTheTipsCentroid) {
  // ∫ z over hemispheres pi/4 (R⁴ - r⁴), over the sleeve -pi/2 (R² - r²) L².
  const Geometry g;
  const double pi = 3.14159265358979, R = g.tip_radius, r = g.rod_radius, L = g.sleeve_length;
  const double height =
      (pi / 4 * (std::pow(R, 4) - std::pow(r, 4)) - pi / 2 * (R * R - r * r) * L * L) /
      g.tip_volume();
  const LatticeBody body = lattice::build_cut_tip(
      g, {}, skew_settings(ModelKind::hookean, Kinematics::small, 0.01 / 7), 1);
  Vector3 sum = Vector3::Zero();
  double mass = 0.0;
  for (std::size_t p = 0; p < body.rest.size(); ++p) {
    mass += body.mass[p];
    sum += body.mass[p] * body.rest[p];
  }
  EXPECT_LT((sum / mass - Vector3(0.0, 0.0, height)).norm(), 1e-6 * R);
}

TEST(CutLattice, EmbeddedPointsStayNearTheirCells) {
  for (const LatticeSettings& settings :
       {settings_for(ModelKind::hookean, Kinematics::small, 0.000833333),
        skew_settings(ModelKind::hookean, Kinematics::small, 0.01 / 7)}) {
    const LatticeBody body = lattice::build_cut_tip({}, {}, settings, 1);
    for (const auto* points : {&body.bond, &body.outer}) {
      for (const EmbeddedPoint& point : *points) {
        Vector3 position = Vector3::Zero();
        double sum = 0.0;
        for (std::size_t c = 0; c < 8; ++c) {
          position += point.weights[c] * body.rest[point.corners[c]];
          sum += point.weights[c];
          ASSERT_LT(std::abs(point.weights[c]), 1.1);
        }
        ASSERT_NEAR(sum, 1.0, 1e-13);
        ASSERT_LT((position - point.rest).norm(), 1e-15);
      }
    }
  }
}

TEST(CutLattice, TiesAreProportionalToAreaAndShearModulus) {
  const double a = 0.001;
  const Rubber rubber;
  for (const ModelKind model : cut_models) {
    LatticeSettings settings = settings_for(model, Kinematics::small, a);
    settings.ligament_stiffness = 0.5;
    const LatticeBody body = lattice::build_cut_tip({}, rubber, settings, 4);
    const double per_area = lattice::tie_stiffness * rubber.shear_modulus / a;
    for (const EmbeddedPoint& point : body.outer) {
      ASSERT_NEAR(point.stiffness / (per_area * point.area), 1.0, 1e-12);
    }
    for (const EmbeddedPoint& point : body.bond) {
      ASSERT_NEAR(point.stiffness / (0.5 * per_area * point.area), 1.0, 1e-12);
    }
  }
}

TEST(CutLattice, SectorsAreEqualPartsOfTheTip) {
  for (const ModelKind model : cut_models) {
    for (const Kinematics kinematics : both_kinematics) {
      LatticeSettings settings = settings_for(model, kinematics, 0.01 / 6);
      settings.offset.z() = 0.3;
      std::map<int, double> elastic, bond, outer_area;
      for (const int sectors : {1, 2, 4}) {
        const LatticeBody body = lattice::build_cut_tip({}, {}, settings, sectors);
        ASSERT_EQ(body.sectors, sectors);
        const VectorXd u =
            on_particles(body, [](const Vector3& x) { return mirrored_field(x, 0.1); });
        elastic[sectors] = sectors * elastic_energy(body, u);
        bond[sectors] = sectors * bond_energy(body, u);
        outer_area[sectors] = sectors * area_of(body.outer);
      }
      for (const int sectors : {2, 4}) {
        EXPECT_NEAR(elastic[sectors] / elastic[1], 1.0, 1e-12) << name(model) << name(kinematics);
        EXPECT_NEAR(bond[sectors] / bond[1], 1.0, 1e-12) << name(model) << name(kinematics);
        EXPECT_NEAR(outer_area[sectors] / outer_area[1], 1.0, 1e-12);
      }
    }
  }
}

TEST(CutLattice, MirrorPlanesHoldTheComponentAcrossThem) {
  const auto settings = settings_for(ModelKind::hookean, Kinematics::small, 0.01 / 6);
  for (const int sectors : {1, 2, 4}) {
    const LatticeBody body = lattice::build_cut_tip({}, {}, settings, sectors);
    int held = 0;
    for (std::size_t p = 0; p < body.rest.size(); ++p) {
      const bool on_x = std::abs(body.rest[p].x()) < 1e-9, on_y = std::abs(body.rest[p].y()) < 1e-9;
      ASSERT_EQ(body.fixed[3 * p], sectors == 4 && on_x);
      ASSERT_EQ(body.fixed[3 * p + 1], sectors > 1 && on_y);
      ASSERT_EQ(body.fixed[3 * p + 2], 0);
      held += body.fixed[3 * p] + body.fixed[3 * p + 1];
      ASSERT_TRUE(sectors == 1 || body.rest[p].y() > -1e-9);
      ASSERT_TRUE(sectors != 4 || body.rest[p].x() > -1e-9);
    }
    EXPECT_EQ(held > 0, sectors > 1);
  }
}

TEST(CutLattice, PublishedBodyHasEverySpringOfThePaper) {
  const Geometry geometry;
  const Rubber rubber;
  LatticeSettings settings = settings_for(ModelKind::published, Kinematics::finite, 0.01 / 7);
  settings.constants = lattice::published_constants(rubber, settings.spacing);
  const auto model = lattice::build_published_tip(geometry, rubber, settings);
  const LatticeBody body = lattice::body_of(model, geometry, rubber);
  // All pairs of the paper's points that are neighbours, joined by E a²/l0.
  const double a = settings.spacing;
  std::size_t pairs = 0, hung = 0, skin = 0;
  double stiffness = 0.0;
  for (std::size_t p = 0; p < body.rest.size(); ++p) {
    ASSERT_TRUE(geometry.contains(body.rest[p], 1e-9 * geometry.tip_radius));
    if (Geometry::radial_distance(body.rest[p]) <= geometry.rod_radius + a * (1 + 1e-9)) ++hung;
    for (std::size_t q = 0; q < p; ++q) {
      const double length = (body.rest[p] - body.rest[q]).norm();
      if (length > 1.8 * a) continue;
      ++pairs;
      stiffness += rubber.youngs_modulus * a * a / length;
    }
  }
  double sum = 0.0;
  for (const Spring& spring : body.springs) {
    const double length = (body.rest[spring.ends[1]] - body.rest[spring.ends[0]]).norm();
    ASSERT_NEAR(spring.stiffness * length / (rubber.youngs_modulus * a * a), 1.0, 1e-9);
    sum += spring.stiffness;
  }
  EXPECT_EQ(body.springs.size(), pairs);
  EXPECT_NEAR(sum / stiffness, 1.0, 1e-9);
  EXPECT_EQ(body.bond.size(), hung);
  for (const std::uint32_t point : model.boundary) {
    skin += model.rest_position(point).z() >= -geometry.thickness();
  }
  EXPECT_EQ(body.outer.size(), skin);
  EXPECT_GT(skin, 100u);
  for (const auto* points : {&body.bond, &body.outer}) {
    for (const EmbeddedPoint& point : *points) {
      ASSERT_EQ(point.rest, body.rest[point.corners[0]]);
      ASSERT_EQ(point.weights[0], 1.0);
      ASSERT_EQ(std::count(point.weights.begin(), point.weights.end(), 0.0), 7);
    }
  }
  EXPECT_TRUE(body.finite && body.fibres.empty() && body.cells.empty());
  const double mass = std::accumulate(body.mass.begin(), body.mass.end(), 0.0);
  EXPECT_NEAR(mass / (rubber.density * geometry.tip_volume()), 1.0, 1e-12);
  EXPECT_THROW_SAYING(
      lattice::body_of(
          lattice::build_cut_model(geometry, rubber,
                                   settings_for(ModelKind::hookean, Kinematics::small, 0.01 / 6)),
          geometry, rubber),
      meshes::InvalidInput, "lattice.model");
}

TEST(CutLattice, SymmetryIsThatOfGridAndPress) {
  LatticeSettings settings;
  meshes::PressProtocol straight, tilted, sideways;
  tilted.tilt = 0.1;
  sideways.lateral = -1e-3;
  settings.offset.z() = 0.4;
  EXPECT_EQ(largest_symmetry({}, settings, straight), 4);
  EXPECT_EQ(largest_symmetry({}, settings, tilted), 2);
  EXPECT_EQ(largest_symmetry({}, settings, sideways), 2);
  settings.offset.x() = 0.1;
  EXPECT_EQ(largest_symmetry({}, settings, straight), 2);
  EXPECT_EQ(largest_symmetry({}, settings, tilted), 2);
  settings.offset.y() = 0.1;
  EXPECT_EQ(largest_symmetry({}, settings, straight), 1);
  settings.offset = Vector3::Zero();
  settings.axes = Eigen::AngleAxisd(0.1, Vector3::UnitZ()).toRotationMatrix();
  EXPECT_EQ(largest_symmetry({}, settings, straight), 1);
  settings.axes = Matrix3d::Identity();
  settings.model = ModelKind::published;
  EXPECT_EQ(largest_symmetry({}, settings, straight), 1);
}

TEST(CutLattice, RefusesBadInput) {
  const auto good = settings_for(ModelKind::hookean, Kinematics::small, 0.01 / 4);
  const auto key_of = [](const LatticeSettings& settings, int sectors, const Rubber& rubber = {},
                         const Geometry& geometry = {}) -> std::string {
    try {
      lattice::build_cut_tip(geometry, rubber, settings, sectors);
    } catch (const meshes::InvalidInput& error) {
      EXPECT_FALSE(error.violations().front().rule.empty());
      EXPECT_FALSE(error.violations().front().remedy.empty());
      return error.violations().front().key;
    }
    return "";
  };
  const auto with = [&](const std::function<void(LatticeSettings&)>& change) {
    LatticeSettings settings = good;
    change(settings);
    return settings;
  };
  EXPECT_EQ(key_of(good, 4), "");
  EXPECT_EQ(key_of(good, 3), "sectors");
  EXPECT_EQ(key_of(with([](auto& s) { s.offset.x() = 0.5; }), 4), "sectors");
  EXPECT_EQ(key_of(with([](auto& s) { s.offset.x() = 0.5; }), 2), "");
  EXPECT_EQ(key_of(with([](auto& s) { s.offset.y() = 0.5; }), 2), "sectors");
  EXPECT_EQ(key_of(with([](auto& s) { s.offset.z() = 1.5; }), 1), "lattice.offset");
  EXPECT_EQ(key_of(with([](auto& s) { s.axes *= 1.1; }), 1), "lattice.rotation");
  EXPECT_EQ(key_of(with([](auto& s) { s.spacing = 0.003; }), 1), "lattice.spacing");
  EXPECT_EQ(key_of(with([](auto& s) { s.spacing = 1e-5; }), 1), "lattice.spacing");
  EXPECT_EQ(key_of(with([](auto& s) { s.spacing = std::nan(""); }), 1), "lattice.spacing");
  EXPECT_EQ(key_of(with([](auto& s) { s.ligament_stiffness = 0.0; }), 1),
            "lattice.ligament_stiffness");
  EXPECT_EQ(key_of(with([](auto& s) { s.constants.kappa = std::nan(""); }), 1),
            "lattice.constants");
  EXPECT_EQ(key_of(with([](auto& s) { s.model = ModelKind::published; }), 1), "lattice.model");
  const auto network = [&](Kinematics kinematics) {
    return settings_for(ModelKind::network, kinematics, 0.01 / 4);
  };
  Rubber auxetic;
  auxetic.youngs_modulus = 1.9 * auxetic.shear_modulus;
  EXPECT_EQ(key_of(network(Kinematics::finite), 4, auxetic), "rubber.youngs_modulus");
  EXPECT_EQ(key_of(network(Kinematics::small), 4, auxetic), "");
  auxetic.youngs_modulus = 2.0 * auxetic.shear_modulus;
  EXPECT_EQ(key_of(network(Kinematics::finite), 4, auxetic), "");
  Geometry inverted;
  inverted.rod_radius = 0.02;
  EXPECT_EQ(key_of(good, 1, {}, inverted), "geometry.rod_radius");
}
