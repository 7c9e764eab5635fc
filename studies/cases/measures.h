/// The numbers by which a validation is judged.
#pragma once

#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace fingertip::studies {

/// The three lattice models, in the order of the report.
const std::vector<std::string>& validated_models();

/// All measures a criterion may name (studies/cases/README.md says what each is).
std::vector<std::string> measure_names();

/// The measures' values for a validate run: `summary` is its summary.json so far, `press` the
/// summary.json of each model's press, `cubes` the largest relative deviation of the hookean cubes
/// from the rubber's E, G, nu. A measure that could not be taken is absent.
std::map<std::string, double> take_measures(
    const nlohmann::ordered_json& summary,
    const std::map<std::string, nlohmann::ordered_json>& press, double cubes);

}  // namespace fingertip::studies
