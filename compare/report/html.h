// This file generates the compare tool's HTML pages from templates, styles and scripts that are embedded in the
// program, and from data that is escaped for embedding.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace duet::compare {

/// These are the sources of one kind of page, embedded by embed.cmake from a folder of .html, .css and .js files.
struct PageSource {
    std::string_view html; ///< with the placeholders {{title}}, {{css}}, {{data}} and {{js}}
    std::string_view css, js;
};

extern const PageSource kReportSource; ///< compare/report/page/
extern const PageSource kLadderSource; ///< compare/ladder/page/
extern const PageSource kBenchSource;  ///< compare/bench/page/

/// Returns the complete page as one self-contained file. `title` is plain text; `data` becomes the JSON of its
/// script element.
std::string make_page(const PageSource& source, const std::string& title, const nlohmann::json& data);

} // namespace duet::compare
