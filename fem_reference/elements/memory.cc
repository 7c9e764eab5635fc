#include "fem_reference/elements/memory.h"

#include <cmath>
#include <utility>

#include "meshes/rubber/hyperelastic_law.h"

namespace fingertip::fem_reference::inline elements {

template <int dim>
std::unique_ptr<ElementKernel<dim>> make_kernel(const ReferenceJob& job, double lasting,
                                                double relaxing, const PointStresses* carried) {
  const meshes::Rubber& rubber = job.rubber;
  const bool bulk = rubber.relaxation.bulk;
  const double shear = (lasting + relaxing) * rubber.shear_modulus;
  if (job.strain == Strain::linear) {
    const double relaxing_lambda = bulk ? rubber.lame_lambda() : -2.0 / 3.0 * rubber.shear_modulus;
    return std::make_unique<HookeKernel<dim>>(
        lasting * rubber.lame_lambda() + relaxing * relaxing_lambda, shear, job.volumetric);
  }
  const meshes::HyperelasticLaw whole(rubber);  // checks it
  const double volumetric = (lasting + (bulk ? relaxing : 0.0)) * whole.volumetric_modulus();
  return std::make_unique<HyperelasticKernel<dim>>(
      meshes::HyperelasticLaw(rubber.energy, shear, volumetric), job.volumetric, carried);
}

bool RelaxationStep::set(double duration) {
  constexpr double round_off = 1e-9;  // of a length divided into equal steps
  if (empty() || std::abs(duration - duration_) <= round_off * duration) return false;
  duration_ = duration;
  recursions_.clear();
  for (const meshes::RelaxationBranch& branch : relaxation_.branches)
    recursions_.emplace_back(duration, branch.time);
  return true;
}

double RelaxationStep::stiffening() const {
  double sum = 0.0;
  for (std::size_t i = 0; i < recursions_.size(); ++i) sum += relative_modulus(i) * gain(i);
  return sum;
}

template <int dim>
LinearMemory<dim>::LinearMemory(const Body<dim>& body, const ReferenceJob& job)
    : step_(job.rubber.relaxation) {
  if (empty()) return;
  kernel_ = make_kernel<dim>(job, 0.0, 1.0);
  system_ = std::make_unique<LinearSystem>(body, false);
  assemble(body, *kernel_, body.fine.vector(), *system_);
  branches_.assign(step_.size(), body.fine.vector());
}

template <int dim>
void LinearMemory<dim>::add_load(const Vector& u, Vector& load) const {
  if (empty()) return;
  Vector remembered =
      sum_of([&](std::size_t i) { return -step_.relative_modulus(i) * step_.decay(i); });
  remembered.add(stiffening(), u);
  load += relaxing_force(remembered);
}

template <int dim>
void LinearMemory<dim>::advance(const Vector& from, const Vector& to) {
  for (std::size_t i = 0; i < branches_.size(); ++i) {
    branches_[i] *= step_.decay(i);
    branches_[i].add(step_.gain(i), to, -step_.gain(i), from);
  }
}

template <int dim>
Vector LinearMemory<dim>::past() const {
  return empty() ? Vector() : sum_of([&](std::size_t i) { return step_.relative_modulus(i); });
}

template <int dim>
Vector LinearMemory<dim>::sum_of(const auto& factor) const {
  Vector sum = branches_.front();
  sum *= factor(0);
  for (std::size_t i = 1; i < branches_.size(); ++i) sum.add(factor(i), branches_[i]);
  return sum;
}

template <int dim>
Vector LinearMemory<dim>::relaxing_force(const Vector& displacement) const {
  Vector force = displacement;
  if (empty())
    force = 0.0;
  else
    system_->matrix.vmult(force, displacement);
  return force;
}

template <int dim>
double LinearMemory<dim>::energy() const {
  double sum = 0.0;
  for (std::size_t i = 0; i < branches_.size(); ++i)
    sum += 0.5 * step_.relative_modulus(i) * (branches_[i] * relaxing_force(branches_[i]));
  return sum;
}

template <int dim>
double LinearMemory<dim>::dissipation_rate() const {
  double sum = 0.0;
  for (std::size_t i = 0; i < branches_.size(); ++i)
    sum +=
        step_.relative_modulus(i) / step_.time(i) * (branches_[i] * relaxing_force(branches_[i]));
  return sum;
}

template <int dim>
PointMemory<dim>::PointMemory(const Body<dim>& body, const ReferenceJob& job)
    : body_(&body), step_(job.rubber.relaxation) {
  if (empty()) return;
  kernel_ = make_kernel<dim>(job, 0.0, 1.0);
  stress_.points = dealii::QGauss<dim>(unsigned(body.degree()) + 1).size();
  stress_.values.setZero(6, stress_.points * Eigen::Index(body.triangulation.n_active_cells()));
  branches_.assign(step_.size(), stress_);
  carried_ = stress_;
}

template <int dim>
void PointMemory<dim>::start_step(double duration) {
  if (empty()) return;
  step_.set(duration);
  carried_.values = -stiffening() * stress_.values;
  for (std::size_t i = 0; i < branches_.size(); ++i)
    carried_.values += step_.relative_modulus(i) * step_.decay(i) * branches_[i].values;
}

template <int dim>
void PointMemory<dim>::advance(const Vector& displacement) {
  if (empty()) return;
  const SymmetricTensors before = stress_.values;
  for_each_element(
      *body_, *kernel_, displacement,
      [&](const CellIterator<dim>& cell, const dealii::FullMatrix<double>&,
          const dealii::Vector<double>&, const ElementSystem& element) {
        stress_.of_cell(cell->active_cell_index()) = element.stresses;
      },
      Parts::stresses);
  for (std::size_t i = 0; i < branches_.size(); ++i)
    branches_[i].values =
        step_.decay(i) * branches_[i].values + step_.gain(i) * (stress_.values - before);
}

template <int dim>
PointStresses PointMemory<dim>::past() const {
  PointStresses sum = stress_;
  sum.values.setZero();
  for (std::size_t i = 0; i < branches_.size(); ++i)
    sum.values += step_.relative_modulus(i) * branches_[i].values;
  return sum;
}

template <int dim>
std::vector<PointStresses*> PointMemory<dim>::stresses() {
  std::vector<PointStresses*> all;
  if (!empty()) all.push_back(&stress_);
  for (PointStresses& branch : branches_) all.push_back(&branch);
  return all;
}

template <int dim>
std::vector<const PointStresses*> PointMemory<dim>::stresses() const {
  std::vector<const PointStresses*> all;
  if (!empty()) all.push_back(&stress_);
  for (const PointStresses& branch : branches_) all.push_back(&branch);
  return all;
}

template std::unique_ptr<ElementKernel<2>> make_kernel(const ReferenceJob&, double, double,
                                                       const PointStresses*);
template std::unique_ptr<ElementKernel<3>> make_kernel(const ReferenceJob&, double, double,
                                                       const PointStresses*);
template class LinearMemory<2>;
template class LinearMemory<3>;
template class PointMemory<2>;
template class PointMemory<3>;

}  // namespace fingertip::fem_reference::inline elements
