// What every page of the compare tool is made with: a template, styles and scripts that are built into the program, and
// data that is safe to put into them.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace duet::compare {

/// The source of one kind of page, embedded by embed.cmake from a folder of .html, .css and .js files.
struct PageSource {
    std::string_view html; ///< with the marks {{title}}, {{css}}, {{data}} and {{js}}
    std::string_view css, js;
};

extern const PageSource kReportSource; ///< compare/report/page/
extern const PageSource kLadderSource; ///< compare/ladder/page/
extern const PageSource kBenchSource;  ///< compare/bench/page/

/// The whole page, one self-contained file: `title` is text, `data` becomes the JSON of its script element.
std::string make_page(const PageSource& source, const std::string& title, const nlohmann::json& data);

} // namespace duet::compare
