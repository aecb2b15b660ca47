#include "raytrace/film/film_file.h"

#include "common/image/image_file.h"
#include "common/system/error.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>

namespace duet {

namespace {

const std::string kPrefix = "duet:film.", kFirstSample = "first sample";
constexpr char kColors[] = {'R', 'G', 'B'};

std::string sum_name(std::size_t replicate, std::size_t color, bool high) {
    return message("sum", replicate, '.', kColors[color], high ? ".high" : ".low");
}
std::string count_name(std::size_t replicate) { return message("count", replicate); }

/// Finds the integer channels of an EXR file by name. A missing channel throws an Error.
class Channels {
public:
    Channels(const std::filesystem::path& path, const ExrFile& file) : path_(path), file_(file) {}

    const std::vector<std::uint32_t>& operator[](const std::string& name) const {
        for (const ExrChannel& channel : file_.channels)
            if (channel.name == name && !channel.integers.empty()) return channel.integers;
        throw Error(message(path_.string(), ": no film: found no channel ", name,
                            " of integers, expected what raytrace --film has written"));
    }

private:
    const std::filesystem::path& path_;
    const ExrFile& file_;
};

std::uint32_t parse_number(const std::filesystem::path& path, const std::string& text) {
    std::uint32_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size())
        throw Error(message(path.string(), ": ", kPrefix, kFirstSample, ": found ", text, ", expected a number"));
    return value;
}

} // namespace

void write_film(const std::filesystem::path& path, const StoredFilm& stored) {
    const Film& film = stored.film;
    const Image<Film::Pixel>& pixels = film.pixels();
    std::vector<ExrChannel> channels = rgb_channels("", film.image());
    for (std::size_t r = 0; r < Film::kReplicates; ++r) {
        for (std::size_t c = 0; c < 3; ++c)
            for (const bool high : {true, false})
                channels.push_back(exr_channel(sum_name(r, c, high), pixels, [&](const Film::Pixel& pixel) {
                    const auto bits = std::bit_cast<std::uint64_t>(pixel.sum[r][c]);
                    return static_cast<std::uint32_t>(high ? bits >> 32 : bits);
                }));
        const auto count = [&](const Film::Pixel& pixel) { return pixel.count[r]; };
        channels.push_back(exr_channel(count_name(r), pixels, count));
    }
    channels.push_back(exr_channel("invalid", pixels, &Film::Pixel::invalid));
    channels.push_back(exr_channel("target", pixels, &Film::Pixel::target));
    std::vector<ExrAttribute> attributes{{kPrefix + kFirstSample, std::to_string(stored.first_sample)}};
    for (const auto& [name, value] : stored.settings) attributes.push_back({kPrefix + name, value});
    write_exr(path, film.width(), film.height(), channels, attributes);
}

StoredFilm read_film(const std::filesystem::path& path) {
    const ExrFile file = read_exr(path);
    const Channels channels(path, file);
    StoredFilm stored{Film(file.width, file.height), {}, 0};
    Image<Film::Pixel>& pixels = stored.film.pixels();
    for (std::size_t r = 0; r < Film::kReplicates; ++r) {
        for (std::size_t c = 0; c < 3; ++c) {
            const auto &high = channels[sum_name(r, c, true)], &low = channels[sum_name(r, c, false)];
            for (std::size_t i = 0; i < pixels.size(); ++i) {
                const double sum = std::bit_cast<double>(std::uint64_t{high[i]} << 32 | low[i]);
                if (!std::isfinite(sum) || sum < 0)
                    throw Error(message(path.string(), ": a sum of ", sum, ", expected a finite one of at least 0"));
                pixels[i].sum[r][c] = sum;
            }
        }
        const auto& count = channels[count_name(r)];
        for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i].count[r] = count[i];
    }
    const auto &invalid = channels["invalid"], &target = channels["target"];
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        pixels[i].invalid = invalid[i];
        pixels[i].target = target[i];
    }
    for (const auto& [name, value] : file.attributes) {
        if (!name.starts_with(kPrefix)) continue;
        const std::string setting = name.substr(kPrefix.size());
        if (setting == kFirstSample)
            stored.first_sample = parse_number(path, value);
        else
            stored.settings.push_back({setting, value});
    }
    return stored;
}

void check_same_image(const std::string& name, const StoredFilm& found, const StoredFilm& expected) {
    const auto check = [&](const std::string& what, const std::string& found_value, const std::string& expected_value) {
        if (found_value != expected_value)
            throw Error(message(name, ": a film of another image: ", what, ": found ", found_value, ", expected ",
                                expected_value));
    };
    const auto size = [](const Film& film) { return message(film.width(), " x ", film.height()); };
    check("size", size(found.film), size(expected.film));
    for (const auto& [setting, value] : expected.settings) {
        const auto same_name = [&, &setting = setting](const StoredFilm::Setting& s) { return s.name == setting; };
        const auto other = std::find_if(found.settings.begin(), found.settings.end(), same_name);
        check(setting, other == found.settings.end() ? "none" : other->value, value);
    }
}

} // namespace duet
