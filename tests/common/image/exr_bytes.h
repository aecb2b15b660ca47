// This header builds uncompressed EXR files byte by byte (openexr.com, "OpenEXR File Layout"), including files that
// our writer never produces.
#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <vector>

namespace duet::test {

/// Builds a byte string to which numbers are appended in little-endian order.
class Bytes {
public:
    template <typename Number> Bytes& add(Number value) {
        const auto bits = static_cast<std::uint64_t>(value);
        for (unsigned shift = 0; shift < 8 * sizeof(Number); shift += 8)
            text += static_cast<char>(bits >> shift & 255u);
        return *this;
    }
    Bytes& add_float(float value) { return add(std::bit_cast<std::uint32_t>(value)); }
    Bytes& add_text(const std::string& value) {
        text += value;
        text += '\0';
        return *this;
    }
    std::string text;
};

/// Holds the header fields and the pixels of an EXR file. The defaults describe a valid file of 3 x 2 half-float
/// pixels.
struct ExrBytes {
    int min_x = -5, min_y = 7, max_x = -3, max_y = 8; // the data window; the display window differs
    // The version includes flags: 0x200 is tiled, 0x800 deep, 0x1000 multipart.
    std::uint32_t version = 2;
    std::int32_t type = 1, sampling = 1;              // type: 0 UINT, 1 HALF, 2 FLOAT
    std::uint8_t compression = 0;
    std::uint32_t tile_width = 0, tile_height = 0;
    int extra_channels = 0;
    std::vector<std::string> channels{"B", "G", "R"};

    static void attribute(Bytes& file, const char* name, const char* attribute_type, const Bytes& value) {
        file.add_text(name).add_text(attribute_type).add(static_cast<std::int32_t>(value.text.size()));
        file.text += value.text;
    }

    std::string header() const {
        Bytes list;
        std::vector<std::string> names = channels;
        for (int i = 0; i < extra_channels; ++i) names.push_back("extra" + std::to_string(i));
        for (const std::string& name : names)
            list.add_text(name).add(type).add(std::int32_t{0}).add(sampling).add(sampling);
        list.add(std::uint8_t{0});
        Bytes file;
        file.add(std::uint32_t{20000630}).add(version);
        attribute(file, "channels", "chlist", list);
        attribute(file, "compression", "compression", Bytes().add(compression));
        attribute(file, "dataWindow", "box2i", Bytes().add(min_x).add(min_y).add(max_x).add(max_y));
        attribute(file, "displayWindow", "box2i", Bytes().add(0).add(0).add(99).add(49));
        attribute(file, "lineOrder", "lineOrder", Bytes().add(std::uint8_t{0}));
        attribute(file, "pixelAspectRatio", "float", Bytes().add_float(1));
        attribute(file, "screenWindowCenter", "v2f", Bytes().add_float(0).add_float(0));
        attribute(file, "screenWindowWidth", "float", Bytes().add_float(1));
        if (tile_width > 0)
            attribute(file, "tiles", "tiledesc", Bytes().add(tile_width).add(tile_height).add(std::uint8_t{0}));
        return file.add(std::uint8_t{0}).text;
    }

    /// Returns the whole file. value(channel, x, y) gives a pixel's bits, with x and y relative to the window's
    /// corner.
    template <typename Value> std::string build(Value value) const {
        const bool tiled = tile_width > 0;
        const int width = max_x - min_x + 1, height = max_y - min_y + 1;
        const int step_x = tiled ? static_cast<int>(tile_width) : width,
                  step_y = tiled ? static_cast<int>(tile_height) : 1;
        std::vector<std::string> chunks;
        for (int y0 = 0; y0 < height; y0 += step_y)
            for (int x0 = 0; x0 < width; x0 += step_x) {
                Bytes pixels;
                for (int y = y0; y < y0 + step_y && y < height; ++y)
                    for (std::size_t c = 0; c < channels.size(); ++c)
                        for (int x = x0; x < x0 + step_x && x < width; ++x) {
                            if (type == 1)
                                pixels.add(static_cast<std::uint16_t>(value(c, x, y)));
                            else
                                pixels.add(static_cast<std::uint32_t>(value(c, x, y)));
                        }
                Bytes chunk;
                if (tiled)
                    chunk.add(x0 / step_x).add(y0 / step_y).add(0).add(0);
                else
                    chunk.add(min_y + y0);
                chunk.add(static_cast<std::int32_t>(pixels.text.size()));
                chunks.push_back(chunk.text + pixels.text);
            }
        Bytes file;
        file.text = header();
        std::uint64_t offset = file.text.size() + 8 * chunks.size();
        for (const std::string& chunk : chunks) {
            file.add(offset);
            offset += chunk.size();
        }
        for (const std::string& chunk : chunks) file.text += chunk;
        return file.text;
    }
};

} // namespace duet::test
