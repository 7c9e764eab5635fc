/// The chapters on presses, vibrations and grasps. One without blocks is left out of the page.
#pragma once

#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "studies/files/real_time_record.h"
#include "studies/report/page/words.h"
#include "studies/report/results/contact_comparison.h"
#include "studies/report/results/grasp_run.h"
#include "studies/report/results/marker_comparison.h"
#include "studies/report/results/moving_press.h"
#include "studies/report/results/run_data.h"

namespace fingertip::studies::report::inline chapters::inline press {

/// Force against indentation of continuum and lattices, and the relative error.
Chapter force_chapter(const RunData& run);
/// Speed, tilt and force of the models under the controller.
Chapter control_chapter(const RunData& run);
/// The models at a few moments of their presses.
Chapter snapshots_chapter(const RunData& run);
/// The mesh and the lattices.
Chapter pictures_chapter(const RunData& run);
using SampleRange = std::span<const meshes::PressSample>;
/// A quantity of samples, as tables and figures show it.
struct SampleColumn {
  const char* title;
  double meshes::PressSample::*value;
  ShownUnit unit;
  const char* direction = "";  ///< before the unit

  /// "lateral force [mN]"
  std::string label(const std::string& where = "") const;
};
/// What samples are ordered by.
SampleColumn indentation();
/// A motion of the plane at one depth: how far, and what holds against it.
struct PlaneMotion {
  SampleColumn way, load;
};
/// Those that samples make, of lateral displacement and twist; mostly none.
std::vector<PlaneMotion> plane_motions(SampleRange samples);
/// Whether samples make the motion.
bool makes(SampleRange samples, const PlaneMotion& motion);
/// The motions that followed presses, of all runs together.
std::vector<PlaneMotion> motions_of(const std::vector<RunContact>& runs);
/// A figure for each, of these names.
void append_motions(const std::vector<RunContact>& runs, const char* lateral, const char* twist,
                    std::vector<Figure>& figures);
/// The samples of these motions, from the last of the first loading on; none without motion.
SampleRange moved_along_plane(const meshes::PressResponse& response);
/// Force, error, lateral force, torque about the normal, contact radius and pressures, as far as
/// they are known, beside what the samples are ordered by.
Table sample_table(SampleRange samples, const std::vector<SampleColumn>& over);
/// Rows of a table that a reader takes in; the figure and its CSV have every sample.
inline constexpr std::size_t max_rows = 20;
/// Every 2nd, 5th, 10th ... so that depths stay round, and the last one is among them.
template <class Rows>
auto thinned(const Rows& rows) {
  std::size_t every = 1;
  for (const std::size_t step : {2, 5, 10, 20, 50, 100, 200, 500, 1000})
    if ((rows.size() + every - 1) / every > max_rows) every = step;
  std::vector<std::remove_cvref_t<decltype(rows.front())>> some;
  for (std::size_t i = (rows.size() - 1) % every; i < rows.size(); i += every)
    some.push_back(rows[i]);
  return some;
}
/// Stages of a program: when they were, force at both ends.
Table stage_table(const std::vector<StageEntry>& stages);
/// written() of a template that knows a name and the prefix of its ids: those of a press of a
/// study, of which several stand on one page; both empty without a name.
Chapter written_of(ChapterData chapter, const std::string& name, std::size_t number);
/// Pressure and shear of runs beside the first one, of that alone where it is alone; without blocks
/// when no depth has a field.
/// Of a press of a study, the `number`-th on its page, with a name: what held the plane back, too,
/// where it moved.
Chapter contact_chapter(const ContactComparison& contacts, const std::string& name = "",
                        std::size_t number = 0);
/// Of the continuum and the lattices.
Chapter contact_chapter(const RunData& run);
/// What each taxel feels at the last sample, of runs side by side, and all of them together;
/// without blocks where a run has no skin, or another one.
Chapter skin_chapter(const std::vector<RunContact>& runs, const std::string& name = "",
                     std::size_t number = 0);
/// Where markers are at the last sample that all runs have, and a table over the samples; without
/// blocks when there are no markers.
Chapter marker_chapter(const MarkerComparison& markers, const std::string& name = "",
                       std::size_t number = 0);
/// Of the continuum and the lattices.
Chapter marker_chapter(const RunData& run);
/// Force and contact radius of one press; without blocks when it has no sample. Of a program the
/// force is drawn to its end, from trace.csv where there is one.
Chapter press_chapter(const meshes::PressResponse& response,
                      const std::vector<lattice::TraceRow>& trace = {});
/// How the press went on after its first loading: its stages, force in time. `files` may be empty,
/// but for a lattice's press. Without blocks when nothing followed.
Chapter program_chapter(const meshes::PressResponse& response, const PressFiles& files);
/// What --real-time chose, and what it costs; without blocks when nothing was tried.
Chapter real_time_chapter(const RealTimeRecord& record);
/// The motions of the plane that followed the press; without blocks when none did.
Chapter sliding_chapter(const meshes::PressResponse& response);
/// Its force at full depth in a sentence, its error, and the force at the end of a lateral motion.
std::string press_answer(const meshes::PressResponse& response, const PressSummary& summary);
Table modes_table(const std::vector<VibrationMode>& modes);
/// Frequencies and kinds of motion from modes.csv; without blocks when it is empty.
Chapter modes_chapter(const std::vector<VibrationMode>& modes);
std::string modes_answer(const std::vector<VibrationMode>& modes);

/// The result in one paragraph.
std::string control_answer(const std::vector<MovingPress>& presses);

/// What `presses` did under their controllers; a chapter without blocks when none has a trace.
Chapter control_chapter(const std::vector<MovingPress>& presses);
/// The finger before contact, at first touch, at half depth and at the end, of those `pictured`.
Chapter snapshots_chapter(const std::vector<MovingPress>& presses);
/// Force against indentation beside the transient continuum, and how far presses differ from those
/// they are compared with.
Chapter speed_chapter(const std::vector<MovingPress>& presses);

/// Whether `presses` differ in how time is integrated: their rods are prescribed, nothing is
/// controlled.
bool compares_integrators(const std::vector<MovingPress>& presses);
/// The same for them; the chapter has no blocks for presses of another kind.
std::string integrators_answer(const std::vector<MovingPress>& presses);
Chapter integrators_chapter(const std::vector<MovingPress>& presses);

/// The result in one paragraph.
std::string grasp_answer(const std::vector<GraspRun>& grasps);
/// Fate against grip force, slip while the grip falls, which way friction points, one grasp in
/// time; without blocks when there are no grasps.
Chapter grasp_chapter(const std::vector<GraspRun>& grasps);

}  // namespace fingertip::studies::report::inline chapters::inline press
