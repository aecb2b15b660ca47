// This header escapes bytes that must not reach a terminal.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

namespace duet {

/// Returns the text with each byte that `plain` rejects as \xNN.
template <typename Plain> std::string escaped(std::string_view text, const Plain& plain) {
    std::string out;
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (plain(byte)) {
            out += c;
            continue;
        }
        char code[8];
        std::snprintf(code, sizeof code, "\\x%02x", byte);
        out += code;
    }
    return out;
}

} // namespace duet
