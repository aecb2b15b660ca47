#include "models/format_number.h"

#include <array>
#include <charconv>
#include <string_view>

namespace duet::models {

void append_number(std::string& text, double x, int decimals) {
    std::array<char, 64> buffer;
    const auto result =
        std::to_chars(buffer.data(), buffer.data() + buffer.size(), x, std::chars_format::fixed, decimals);
    std::string_view digits(buffer.data(), static_cast<std::size_t>(result.ptr - buffer.data()));
    if (digits.find('.') != std::string_view::npos) {
        while (digits.ends_with('0')) digits.remove_suffix(1);
        if (digits.ends_with('.')) digits.remove_suffix(1);
    }
    text += digits == "-0" ? "0" : digits;
}

std::string format_number(double x, int decimals) {
    std::string text;
    append_number(text, x, decimals);
    return text;
}

} // namespace duet::models
