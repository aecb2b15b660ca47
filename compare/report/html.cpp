#include "compare/report/html.h"

#include "common/system/error.h"
#include "common/system/escape.h"

#include <map>
#include <nlohmann/json.hpp>

namespace duet::compare {

namespace {

using nlohmann::json;

/// Replaces each {{placeholder}} of the template in one pass. Braces within values are not interpreted.
std::string fill_in(std::string_view page, const std::map<std::string_view, std::string_view>& values) {
    std::string text;
    for (std::size_t at = 0;;) {
        const std::size_t open = page.find("{{", at);
        text += page.substr(at, open - at);
        if (open == std::string_view::npos) return text;
        const std::size_t close = page.find("}}", open);
        DUET_CHECK(close != std::string_view::npos);
        text += values.at(page.substr(open + 2, close - open - 2));
        at = close + 2;
    }
}

/// Returns JSON that is safe within a script element: no text in it can close the element.
std::string script_json(const json& value) {
    std::string text = value.dump(-1, ' ', false, json::error_handler_t::replace);
    for (std::size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at))
        text.replace(at, 1, "\\u003c");
    return text;
}

} // namespace

std::string make_page(const PageSource& source, const std::string& title, const json& data) {
    const std::string escaped_title = markup_escaped(title), embedded = script_json(data);
    return fill_in(source.html,
                   {{"title", escaped_title}, {"css", source.css}, {"data", embedded}, {"js", source.js}});
}

} // namespace duet::compare
