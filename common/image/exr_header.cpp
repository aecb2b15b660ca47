// This file checks the header of an EXR file before OpenEXR reads it. OpenEXR reads most attributes by their type and
// ignores the size that the file gives, so that a wrong size lets it take any bytes for the next attribute.
// Source: "OpenEXR File Layout" and "Attribute Layout" in the documentation of OpenEXR 3.1.
#include "common/image/container_checks.h"

#include <algorithm>
#include <array>
#include <optional>

namespace duet {

namespace {

struct FixedSize {
    std::string_view type;
    std::size_t bytes;
};
constexpr std::array kFixedSizes{
    FixedSize{"box2f", 16},
    FixedSize{"box2i", 16},
    FixedSize{"chromaticities", 32},
    FixedSize{"compression", 1},
    FixedSize{"deepImageState", 1},
    FixedSize{"double", 8},
    FixedSize{"envmap", 1},
    FixedSize{"float", 4},
    FixedSize{"int", 4},
    FixedSize{"keycode", 28},
    FixedSize{"lineOrder", 1},
    FixedSize{"m33d", 72},
    FixedSize{"m33f", 36},
    FixedSize{"m44d", 128},
    FixedSize{"m44f", 64},
    FixedSize{"rational", 8},
    FixedSize{"tiledesc", 9},
    FixedSize{"timecode", 8},
    FixedSize{"v2d", 16},
    FixedSize{"v2f", 8},
    FixedSize{"v2i", 8},
    FixedSize{"v3d", 24},
    FixedSize{"v3f", 12},
    FixedSize{"v3i", 12},
};

/// Reads consecutive fields from the front of a string of bytes. Each function returns nothing where the bytes end
/// early.
class Fields {
public:
    explicit Fields(std::string_view bytes) : rest_(bytes) {}

    std::optional<std::string_view> bytes(std::size_t count) {
        if (count > rest_.size()) return {};
        const std::string_view taken = rest_.substr(0, count);
        rest_.remove_prefix(count);
        return taken;
    }
    std::optional<std::uint32_t> integer() {
        const auto taken = bytes(4);
        if (!taken) return {};
        std::uint32_t value = 0;
        for (std::size_t i = 4; i-- > 0;) value = value << 8 | static_cast<unsigned char>((*taken)[i]);
        return value;
    }
    /// Reads a text that ends with NUL, and returns it without the NUL.
    std::optional<std::string_view> text() {
        const std::size_t end = rest_.find('\0');
        if (end == rest_.npos) return {};
        const std::string_view taken = rest_.substr(0, end);
        rest_.remove_prefix(end + 1);
        return taken;
    }
    bool done() const { return rest_.empty(); }

private:
    std::string_view rest_;
};

/// A channel is its name and 16 bytes, and an empty name ends the list.
bool is_channel_list(Fields fields) {
    for (auto name = fields.text(); name; name = fields.text()) {
        if (name->empty()) return fields.done();
        if (!fields.bytes(16)) return false;
    }
    return false;
}

/// A preview has four bytes for each of width × height pixels.
bool is_preview(Fields fields) {
    const auto width = fields.integer(), height = fields.integer();
    constexpr std::uint32_t kMaxSide = 32768;
    return width && height && *width <= kMaxSide && *height <= kMaxSide &&
           fields.bytes(std::size_t{4} * *width * *height) && fields.done();
}

bool is_list_of_strings(Fields fields) {
    while (!fields.done()) {
        const auto length = fields.integer();
        if (!length || !fields.bytes(*length)) return false;
    }
    return true;
}

bool has_size_of_type(std::string_view type, std::string_view value) {
    if (type == "chlist") return is_channel_list(Fields(value));
    if (type == "preview") return is_preview(Fields(value));
    if (type == "stringvector") return is_list_of_strings(Fields(value));
    const auto* fixed = std::find_if(kFixedSizes.begin(), kFixedSizes.end(),
                                     [&](const FixedSize& known) { return known.type == type; });
    return fixed == kFixedSizes.end() || value.size() == fixed->bytes; // OpenEXR reads other types by their size
}

} // namespace

void check_exr_header(const ImageBytes& file) {
    Fields fields(file.bytes);
    fields.bytes(8); // the magic number and the version
    for (auto name = fields.text(); name; name = fields.text()) {
        if (name->empty()) return;
        const auto type = fields.text();
        const auto size = type ? fields.integer() : std::nullopt;
        const auto value = size ? fields.bytes(*size) : std::nullopt;
        if (!value) break;
        if (!has_size_of_type(*type, *value))
            throw Error(message(file.name, ": corrupt: an EXR attribute of ", value->size(), " bytes, expected ",
                                "another size for its type"));
    }
    throw Error(file.name + ": truncated: the EXR header ends early");
}

} // namespace duet
