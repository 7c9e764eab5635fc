/// Checks on HTML that need no browser.
#pragma once

#include <string>
#include <vector>

namespace fingertip::report_testing {

/// What is wrong with the nesting of tags, in words; empty when every element is closed in order,
/// every attribute is quoted and no id occurs twice.
std::vector<std::string> structure_faults(const std::string& html);

/// The page without the script of its figures and their data.
std::string without_own_scripts(std::string html);

/// Every place that would load something from outside the file or run a script that is not the
/// page's own.
std::vector<std::string> outside_references(const std::string& html);

/// The page without tags, with entities resolved and plain spaces: what a reader sees.
std::string visible_text(const std::string& html);

}  // namespace fingertip::report_testing
