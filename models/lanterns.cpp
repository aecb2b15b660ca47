// This file generates lanterns.json: a night market of 1,000 paper lanterns above stalls, to test the selection among
// many lights.
#include "common/system/file.h"
#include "common/vec/vec.h"
#include "models/format_number.h"
#include "models/generate.h"
#include "models/random.h"

#include <algorithm>
#include <array>

namespace duet::models {
namespace {

constexpr int kDecimals = 3;
constexpr int kLanterns = 1000;
constexpr double kHalfExtent = 12; ///< the market is a square of twice this side, in meters

std::string triple(double x, double y, double z) {
    return "[" + format_number(x, kDecimals) + ", " + format_number(y, kDecimals) + ", " + format_number(z, kDecimals) +
           "]";
}

/// Collects the objects of the scene file.
class Objects {
public:
    void sphere(Vec3d center, double radius, const std::string& material) {
        add("{\"type\": \"sphere\", \"center\": " + triple(center.x, center.y, center.z) +
            ", \"radius\": " + format_number(radius, kDecimals) + ", \"material\": \"" + material + "\"}");
    }
    void box(Vec3d low, Vec3d high, const std::string& material) {
        add("{\"type\": \"box\", \"low\": " + triple(low.x, low.y, low.z) + ", \"high\": " +
            triple(high.x, high.y, high.z) + ", \"material\": \"" + material + "\"}");
    }
    void ground(double reach, const std::string& material) {
        add("{\"type\": \"quad\", \"corner\": " + triple(-reach, 0, reach) + ", \"u\": " + triple(2 * reach, 0, 0) +
            ", \"v\": " + triple(0, 0, -2 * reach) + ", \"material\": \"" + material + "\"}");
    }
    const std::string& text() const { return text_; }

private:
    void add(const std::string& object) { text_ += (text_.empty() ? "    " : ",\n    ") + object; }
    std::string text_;
};

/// The lights have five colors in three intensities each, from a candle behind paper to a bulb.
constexpr std::array<std::array<double, 3>, 5> kColors{
    {{1, 0.55, 0.2}, {1, 0.3, 0.12}, {1, 0.75, 0.4}, {0.9, 0.2, 0.25}, {0.4, 0.6, 1}}};
constexpr std::array<double, 3> kStrengths{4, 12, 60};

std::string emitter_name(std::size_t color, std::size_t strength) {
    return "lamp" + std::to_string(color) + std::to_string(strength);
}

std::string materials() {
    std::string text = "    \"ground\": {\"type\": \"diffuse\", \"albedo\": [0.45, 0.42, 0.4]},\n"
                       "    \"stall\": {\"type\": \"diffuse\", \"albedo\": [0.5, 0.36, 0.25]},\n"
                       "    \"fruit\": {\"type\": \"diffuse\", \"albedo\": [0.6, 0.25, 0.1]},\n"
                       "    \"pot\": {\"type\": \"metal\", \"reflectance\": [0.9, 0.7, 0.5], \"roughness\": 0.4}";
    for (std::size_t color = 0; color < kColors.size(); ++color)
        for (std::size_t strength = 0; strength < kStrengths.size(); ++strength) {
            const auto& c = kColors[color];
            const double s = kStrengths[strength];
            text += ",\n    \"" + emitter_name(color, strength) +
                    "\": {\"type\": \"emissive\", \"radiance\": " + triple(c[0] * s, c[1] * s, c[2] * s) + "}";
        }
    return text;
}

/// Adds a counter with pots and fruit on it, three meters from its neighbors.
void add_stall(Objects& objects, Random& random, double x, double z) {
    const double wide = random.uniform(0.5, 1), deep = random.uniform(0.3, 0.6), high = random.uniform(0.6, 0.9);
    objects.box({x - wide, 0, z - deep}, {x + wide, high, z + deep}, "stall");
    for (int i = 0; i < 6; ++i) {
        const double radius = random.uniform(0.06, 0.16);
        const double px = x + random.uniform(-0.8, 0.8) * wide, pz = z + random.uniform(-0.8, 0.8) * deep;
        objects.sphere({px, high + radius, pz}, radius, i % 3 == 0 ? "pot" : "fruit");
    }
}

} // namespace

void write_lanterns(const std::filesystem::path& folder) {
    Objects objects;
    objects.ground(kHalfExtent * 4, "ground");
    Random random(7);
    for (int row = -3; row <= 3; ++row)
        for (int column = -3; column <= 3; ++column) {
            const double x = 3 * column + random.uniform(-0.4, 0.4), z = 3 * row + random.uniform(-0.4, 0.4);
            add_stall(objects, random, x, z);
        }
    for (int i = 0; i < kLanterns; ++i) {
        const double x = random.uniform(-kHalfExtent, kHalfExtent), z = random.uniform(-kHalfExtent, kHalfExtent);
        const double y = random.uniform(1.3, 2.6), radius = random.uniform(0.025, 0.06);
        const double kind = random.uniform();
        const std::size_t strength = kind < 0.7 ? 0 : kind < 0.97 ? 1 : 2;
        const auto color = std::min(static_cast<std::size_t>(random.uniform() * kColors.size()), kColors.size() - 1);
        objects.sphere({x, y, z}, radius, emitter_name(color, strength));
    }
    write_file(folder / "lanterns.json",
               "{\n  \"description\": \"1,000 lights of 15 kinds over a market: which is worth a shadow ray?\",\n"
               "  \"camera\": {\"eye\": [9, 3.2, 13], \"look_at\": [0, 0.7, 0], \"fov_degrees\": 38},\n"
               "  \"image\": {\"width\": 960, \"height\": 540},\n  \"materials\": {\n" +
                   materials() + "\n  },\n  \"objects\": [\n" + objects.text() +
                   "\n  ],\n  \"environment\": {\"type\": \"constant\", \"radiance\": [0.002, 0.003, 0.006]}\n}\n");
}

} // namespace duet::models
