#include "studies/python/finger.h"

#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "lattice/control/control_loop.h"
#include "lattice/press/press_task.h"
#include "studies/presses/press_setup.h"

namespace fingertip::studies::inline python {

namespace py = pybind11;

namespace {

using lattice::Command;
using lattice::Measurement;
using lattice::Target;
using lattice::Wrench;
using meshes::Vector3;

/// Commands come from Python, whose loop stands in its place.
class Nobody final : public lattice::Controller {
 public:
  Command command(const Measurement&) override { return Wrench{}; }
  void reset() override {}
};

/// The finger of a press, its sensors and actuators, and nobody who controls it.
class Finger {
 public:
  Finger(const std::string& config, const std::vector<std::string>& sets)
      : setup_(free_press({config, sets, {}})),
        way_(setup_.protocol, setup_.geometry),
        finger_(lattice::pressed_finger(setup_, way_)),
        task_(lattice::control_task(setup_, way_, finger_.rod_body())),
        loop_(finger_, nobody_, setup_.hardware, setup_.controller, task_.period) {}

  Measurement reset() {
    loop_.reset();
    return loop_.measure();
  }

  /// Measures, unless that is done, commands, and lets a period pass.
  Measurement step(const Command& command) {
    loop_.measure();
    loop_.command(command);
    loop_.advance();
    const Measurement& seen = loop_.measure();
    if (!seen.pose.position.allFinite() || !lattice::finite(seen.wrench))
      throw meshes::NotConverged("the lattice blew up at " + std::to_string(finger_.time()) +
                                 " s: give a smaller run.time_step");
    return seen;
  }

  Measurement measure() { return loop_.measure(); }
  Target target(double time) const { return task_.path(time); }
  double time() const { return finger_.time(); }
  double indentation() const {
    return way_.indentation(finger_.rod_body().endpoint, finger_.finger().rod().endpoint(),
                            setup_.protocol.clearance);
  }
  double normal_force() const { return finger_.finger().bond().force.dot(way_.plane.normal); }
  const lattice::ControlTask& task() const { return task_; }
  double time_step() const { return finger_.step_report(task_.period).step; }
  const Wrench& applied() const { return loop_.applied(); }

 private:
  lattice::PressSetup setup_;
  lattice::PressWay way_;
  lattice::VirtualFinger finger_;
  lattice::ControlTask task_;
  Nobody nobody_;
  lattice::ControlLoop loop_;
};

/// w, x, y, z
Eigen::Vector4d as_numbers(const Eigen::Quaterniond& q) {
  return {q.w(), q.x(), q.y(), q.z()};
}

Eigen::Quaterniond as_orientation(const Eigen::Vector4d& q) {
  return {q[0], q[1], q[2], q[3]};
}

void add_values(py::module_& module) {
  const Vector3 zero = Vector3::Zero();
  py::class_<Wrench>(module, "Wrench",
                     "A force [N] and a torque [N m] at the rod's endpoint, in world axes.")
      .def(py::init([](const Vector3& force, const Vector3& torque) {
             return Wrench{force, torque};
           }),
           py::arg("force") = zero, py::arg("torque") = zero)
      .def_readwrite("force", &Wrench::force)
      .def_readwrite("torque", &Wrench::torque);
  py::class_<Target>(module, "Target",
                     "Where the rod's endpoint should be and how it should move; the built-in "
                     "servo makes a wrench of it.")
      .def(py::init([](const Vector3& position, const Eigen::Vector4d& orientation,
                       const Vector3& velocity, const Vector3& angular_velocity,
                       const Vector3& acceleration, const Vector3& angular_acceleration) {
             return Target{{position, as_orientation(orientation)},
                           {velocity, angular_velocity},
                           {acceleration, angular_acceleration}};
           }),
           py::arg("position"), py::arg("orientation") = Eigen::Vector4d(1.0, 0.0, 0.0, 0.0),
           py::arg("velocity") = zero, py::arg("angular_velocity") = zero,
           py::arg("acceleration") = zero, py::arg("angular_acceleration") = zero)
      .def_property(
          "position", [](const Target& t) { return t.pose.position; },
          [](Target& t, const Vector3& value) { t.pose.position = value; })
      .def_property(
          "orientation", [](const Target& t) { return as_numbers(t.pose.orientation); },
          [](Target& t, const Eigen::Vector4d& q) { t.pose.orientation = as_orientation(q); })
      .def_property(
          "velocity", [](const Target& t) { return t.twist.velocity; },
          [](Target& t, const Vector3& value) { t.twist.velocity = value; })
      .def_property(
          "acceleration", [](const Target& t) { return t.acceleration.velocity; },
          [](Target& t, const Vector3& value) { t.acceleration.velocity = value; });
  py::class_<lattice::ContactState>(module, "Contact", "What a tactile sensor on the tip tells.")
      .def_readonly("touching", &lattice::ContactState::touching, "Points on the plane.")
      .def_readonly("radius", &lattice::ContactState::radius, "Of the contact patch [m].")
      .def_property_readonly(
          "force", [](const lattice::ContactState& c) { return c.on_tip.force; },
          "Of the plane on the tip [N].")
      .def_property_readonly(
          "torque", [](const lattice::ContactState& c) { return c.on_tip.torque; },
          "Of the plane on the tip, about the rod's endpoint [N m].");
  py::class_<Measurement>(module, "Measurement",
                          "What the robot feels at the rod's endpoint, in world axes, which are "
                          "the rod's starting axes.")
      .def_readonly("time", &Measurement::time, "When it was taken [s].")
      .def_property_readonly(
          "position", [](const Measurement& m) { return m.pose.position; }, "Of the endpoint [m].")
      .def_property_readonly(
          "orientation", [](const Measurement& m) { return as_numbers(m.pose.orientation); },
          "Since the start, a unit quaternion w, x, y, z.")
      .def_property_readonly(
          "velocity", [](const Measurement& m) { return m.twist.velocity; },
          "Of the endpoint [m/s].")
      .def_property_readonly(
          "angular_velocity", [](const Measurement& m) { return m.twist.angular_velocity; },
          "[rad/s]")
      .def_property_readonly(
          "force", [](const Measurement& m) { return m.wrench.force; },
          "Of the tip on the rod [N].")
      .def_property_readonly(
          "torque", [](const Measurement& m) { return m.wrench.torque; },
          "Of the tip on the rod, about the endpoint [N m].")
      .def_readonly("contact", &Measurement::contact,
                    "Contact; None without a tactile sensor (hardware.tactile).")
      .def_property_readonly(
          "taxels",
          [](const Measurement& m) {
            Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> rows(m.taxels.size(), 3);
            for (std::size_t i = 0; i < m.taxels.size(); ++i)
              rows.row(Eigen::Index(i)) << m.taxels[i].normal_stress, m.taxels[i].shear_u,
                  m.taxels[i].shear_v;
            return rows;
          },
          "A row for each taxel of the skin (sensor.taxels): normal stress, shear along u and v "
          "[Pa].")
      .def("__repr__", [](const Measurement& m) {
        return py::str("Measurement(time={:.6g} s, force={} N)").format(m.time, m.wrench.force);
      });
}

}  // namespace

void add_finger(py::module_& module) {
  add_values(module);
  using Quietly = py::call_guard<py::gil_scoped_release>;
  py::class_<Finger>(module, "Finger")
      .def(py::init<const std::string&, const std::vector<std::string>&>(), py::arg("config"),
           py::arg("sets"), Quietly())
      .def("reset", &Finger::reset, Quietly(), "As it was built; its first measurement.")
      .def("step", &Finger::step, py::arg("command") = Wrench{}, Quietly(),
           "Holds a Wrench, or follows a Target, for one period; what is measured then.")
      .def("measure", &Finger::measure, Quietly(), "What is measured now; the same until a step.")
      .def("target", &Finger::target, py::arg("time"),
           "Where the press of the configuration wants the endpoint at that time [s].")
      .def_property_readonly("time", &Finger::time, "[s]")
      .def_property_readonly("indentation", &Finger::indentation,
                             "Travel since first touch, negative before [m].")
      .def_property_readonly("normal_force", &Finger::normal_force,
                             "Of the tip on the rod along the plane's normal, without sensors [N].")
      .def_property_readonly(
          "applied", [](const Finger& finger) { return finger.applied(); },
          "The wrench that acts now, after servo and limits.")
      .def_property_readonly(
          "period", [](const Finger& finger) { return finger.task().period; },
          "Of the control loop [s].")
      .def_property_readonly(
          "depth", [](const Finger& finger) { return finger.task().depth; },
          "Wanted indentation [m].")
      .def_property_readonly(
          "speed", [](const Finger& finger) { return finger.task().speed; },
          "Wanted speed of the approach [m/s].")
      .def_property_readonly(
          "inertia", [](const Finger& finger) { return finger.task().inertia; },
          "Of the rod at its endpoint, 6 x 6 [kg, kg m, kg m²].")
      .def_property_readonly(
          "normal", [](const Finger& finger) { return finger.task().normal; },
          "Of the plane, toward the rod.")
      .def_property_readonly(
          "taxels",
          [](const Finger& finger) {
            const std::vector<meshes::Taxel>& taxels = finger.task().taxels;
            Eigen::Matrix<double, Eigen::Dynamic, 7, Eigen::RowMajor> rows(taxels.size(), 7);
            for (std::size_t i = 0; i < taxels.size(); ++i)
              rows.row(Eigen::Index(i)) << taxels[i].place.transpose(),
                  taxels[i].normal.transpose(), taxels[i].area;
            return rows;
          },
          "A row for each taxel of the skin: its place [m] and outward normal on the undeformed "
          "finger, and the area that it stands for [m²].")
      .def_property_readonly("time_step", &Finger::time_step, "Of the integration [s].");
}

}  // namespace fingertip::studies::inline python
