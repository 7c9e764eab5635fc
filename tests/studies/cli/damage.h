/// Damage to the files of run folders, drawn at random but reproducible.
#pragma once

#include <filesystem>
#include <random>
#include <string>

/// Damages one file somewhere below `folder` and tells how: takes it away, puts a folder or a dead
/// link in its place, cuts or empties it, flips bytes, replaces a number by an infinite, absent,
/// huge or senseless one, takes away or doubles a column or line of a table, gives an entry of a
/// JSON file another type.
std::string damage_something(const std::filesystem::path& folder, std::mt19937& random);
