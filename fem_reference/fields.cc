#include <deal.II/lac/vector.h>
#include <deal.II/numerics/data_out.h>
#include <deal.II/numerics/data_postprocessor.h>

#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include "fem_reference/discretisation.h"
#include "meshes/files.h"

namespace fingertip::fem_reference {
namespace {

constexpr int dim = 3;

/// Cauchy stress and von Mises' equivalent stress at the points of the output.
class StressOutput : public dealii::DataPostprocessor<dim> {
 public:
  explicit StressOutput(const meshes::Rubber& rubber)
      : lambda_(rubber.lame_lambda()), shear_(rubber.shear_modulus) {}

  std::vector<std::string> get_names() const override {
    std::vector<std::string> names(9, "stress");
    names.push_back("von_mises_stress");
    return names;
  }
  std::vector<dealii::DataComponentInterpretation::DataComponentInterpretation>
  get_data_component_interpretation() const override {
    using namespace dealii::DataComponentInterpretation;
    std::vector<DataComponentInterpretation> kinds(9, component_is_part_of_tensor);
    kinds.push_back(component_is_scalar);
    return kinds;
  }
  dealii::UpdateFlags get_needed_update_flags() const override { return dealii::update_gradients; }

  void evaluate_vector_field(const dealii::DataPostprocessorInputs::Vector<dim>& inputs,
                             std::vector<dealii::Vector<double>>& computed) const override {
    for (std::size_t p = 0; p < computed.size(); ++p) {
      double trace = 0.0;
      for (unsigned i = 0; i < dim; ++i) trace += inputs.solution_gradients[p][i][i];
      double deviator_squared = 0.0;
      for (unsigned i = 0; i < dim; ++i)
        for (unsigned j = 0; j < dim; ++j) {
          const double strain =
              (inputs.solution_gradients[p][i][j] + inputs.solution_gradients[p][j][i]) / 2;
          const double deviator = 2 * shear_ * (strain - (i == j ? trace / 3 : 0.0));
          const double mean = i == j ? (lambda_ + 2 * shear_ / 3) * trace : 0.0;
          computed[p](3 * i + j) = float(deviator + mean);
          deviator_squared += deviator * deviator;
        }
      computed[p](9) = std::sqrt(1.5 * deviator_squared);
    }
  }

 private:
  double lambda_, shear_;
};

}  // namespace

void ElasticTip::write_fields(const Eigen::VectorXd& displacement, const Eigen::VectorXd& reaction,
                              const std::filesystem::path& file) const {
  const Discretisation& d = *discretisation_;
  dealii::Vector<double> u(d.dof_handler.n_dofs()), traction(d.dof_handler.n_dofs());
  for (unsigned i = 0; i < u.size(); ++i) {
    u[i] = displacement[i];
    const double area = nodal_area_[std::size_t(node_of_dof_[i])];
    // The plane pushes along -z, so that the pressure is minus the traction's third component.
    const double sign = component_of_dof_[i] == 2 ? -1.0 : 1.0;
    traction[i] = area > 0.0 ? sign * reaction[i] / area : 0.0;
  }
  using namespace dealii::DataComponentInterpretation;
  const StressOutput stress(rubber_);
  dealii::DataOut<dim> out;
  out.add_data_vector(d.dof_handler, u, std::vector<std::string>(dim, "displacement"),
                      std::vector<DataComponentInterpretation>(dim, component_is_part_of_vector));
  out.add_data_vector(d.dof_handler, u, stress);
  out.add_data_vector(d.dof_handler, traction,
                      {"contact_shear_x", "contact_shear_y", "contact_pressure"},
                      std::vector<DataComponentInterpretation>(dim, component_is_scalar));
  out.build_patches(d.mapping, d.element.degree, dealii::DataOut<dim>::curved_inner_cells);
  dealii::DataOutBase::VtkFlags flags;
  flags.compression_level = dealii::DataOutBase::VtkFlags::best_speed;
  out.set_flags(flags);
  meshes::write_atomically(file, [&](std::ostream& stream) { out.write_vtu(stream); });
}

}  // namespace fingertip::fem_reference
