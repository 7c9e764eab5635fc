/// What a skin felt of a press: taxels.csv.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lattice/press/press_setup.h"
#include "meshes/press/taxels.h"

namespace fingertip::studies::inline presses {

/// Writes taxels.csv beside the contact_field.csv of a press of `setup`'s specimen, by lattice or
/// continuum: without noise, rate and latency. Takes an older one away where there is no skin, or
/// no point touched.
void write_taxels(const std::filesystem::path& folder, const lattice::PressSetup& setup);

/// The same, and pictures of the contact for ParaView (pictures/contact_frames.h). Returns what
/// stands in taxels.csv.
std::vector<meshes::TaxelRow> write_contact_files(const std::filesystem::path& folder,
                                                  const lattice::PressSetup& setup);

/// "32 taxels at 3 mm: 512 Pa at most (taxel 5), together 17.9 mN", of the last sample; empty of no
/// row.
std::string taxel_words(const std::vector<meshes::TaxelRow>& rows);

}  // namespace fingertip::studies::inline presses
