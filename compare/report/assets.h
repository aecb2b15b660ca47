// The sources of the report page (compare/report/page/), built into the program.
#pragma once

#include <string_view>

namespace duet::compare {

extern const std::string_view kReportHtml; ///< with the marks {{title}}, {{css}}, {{data}} and {{js}}
extern const std::string_view kReportCss;
extern const std::string_view kReportJs;

} // namespace duet::compare
