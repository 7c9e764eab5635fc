/// Tables of a page as a terminal shows them.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

#include "studies/report/page/document.h"

namespace fingertip::studies::report::inline page {

/// In ASCII: signs and units as they are typed ("1.2e-9", "gf/cm^2", "kappa"), what has no such
/// spelling as "?".
std::string terminal(std::string_view text);

/// Columns as wide as their longest cell; notes in brackets, those of the head behind a comma. In
/// lines of their own where that is too wide.
std::string table_text(const Table& table);

/// Those tables of a chapter, each below its caption.
std::string tables_text(const Chapter& chapter, std::initializer_list<std::string_view> ids);

}  // namespace fingertip::studies::report::inline page
