/// What a skin felt of a press, taxels.csv, and where markers went, markers.csv.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lattice/press/press_setup.h"
#include "meshes/press/taxels.h"

namespace fingertip::studies::inline presses {

/// What a folder's field is of.
enum class FieldOf { lattice, continuum };

/// Writes taxels.csv beside the contact_field.csv and response.csv of a press of `setup`'s
/// specimen, by lattice or continuum: without noise, rate and latency. Takes an older one away
/// where there is no skin, or no point touched.
void write_taxels(const std::filesystem::path& folder, const lattice::PressSetup& setup,
                  FieldOf model);

/// The same, and pictures of the contact for ParaView (pictures/contact_frames.h). Returns what
/// stands in taxels.csv.
std::vector<meshes::TaxelRow> write_contact_files(const std::filesystem::path& folder,
                                                  const lattice::PressSetup& setup, FieldOf model);

/// "32 taxels at 3 mm: 512 Pa at most (taxel 5), together 17.9 mN", of the last sample; empty of no
/// row.
std::string taxel_words(const std::vector<meshes::TaxelRow>& rows);

/// "241 markers at 3 mm: 2.98 mm at most (marker 121), off by up to 0.04 mm", of the last sample of
/// a folder's markers.csv; empty without one.
std::string marker_words(const std::filesystem::path& folder);

/// Of a footprint [m] finer than what the field resolves; empty where none is.
std::string footprint_note(const std::vector<meshes::TaxelRow>& rows, double footprint);

}  // namespace fingertip::studies::inline presses
