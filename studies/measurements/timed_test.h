/// A material test in time, from the rows of its file.
#pragma once

#include <string>
#include <vector>

#include "calibration/material_tests/material_test.h"
#include "studies/measurements/material_test_table.h"

namespace fingertip::studies::inline measurements {

/// Puts times, path, deformations and stresses into `test`, whose kind, course, measure and rate
/// are known, from rows in SI. A strain that is a value is reached at the rate, at once where there
/// is none, and the rows' time counts from the start of that ramp or, as `time.from` says, of the
/// hold. At most `points` rows become stresses: of a relaxation at equal steps of the logarithm of
/// time, of cycles every so many; at most 10 000 rows become corners of the path. A specimen that
/// is only pulled goes slack where it is longer than the machine lets it be: it bears nothing,
/// three rows or more, after it has borne something; a law would have to press it, so that these
/// rows are no stresses. `notes` tell what was left out. Throws InvalidInput: times that do not
/// increase, by their line; a strain that is not held, or held for less than the ramp took; `file`
/// is for messages.
void put_in_time(const TestTable& description, const std::filesystem::path& file,
                 const StrainColumn& strain, bool has_sigma,
                 std::vector<calibration::CurveRow> rows, std::size_t points,
                 calibration::MaterialTest& test, std::vector<std::string>& notes);

}  // namespace fingertip::studies::inline measurements
