// Writes and reads film files. A render can store its film as a checkpoint, a later render can continue it, and the
// films of several computers can be merged.
#pragma once

#include "raytrace/film/film.h"

#include <filesystem>
#include <string>
#include <vector>

namespace duet {

/// Holds a film together with the settings that it was rendered with.
struct StoredFilm {
    /// Holds a setting that determines the samples, for example {"seed", "0"}.
    struct Setting {
        std::string name, value;
        friend bool operator==(const Setting&, const Setting&) = default;
    };

    Film film;
    std::vector<Setting> settings; ///< settings with distinct names, in any order
    std::uint32_t first_sample =
        0; ///< index of every pixel's first sample; Film::samples_taken is the number of samples
};

/// Writes a film as an EXR file that any viewer can display: channels R, G and B are the means of the pixels. Further
/// channels of 32-bit integers store the film's data exactly. Each sum, a double, is stored as the two channels
/// sumN.C.high and sumN.C.low, where N is the replicate and C is R, G or B; the other channels are countN, invalid and
/// target. The settings are text attributes named `duet:film.NAME`. The file is written atomically: it is complete or
/// absent. Throws an Error (exit code 1) if writing fails.
void write_film(const std::filesystem::path& path, const StoredFilm& stored);

/// Reads a film file. The film has exactly the bits that were written. Throws an Error that names the file and the
/// missing or wrong data if the file is not a film.
StoredFilm read_film(const std::filesystem::path& path);

/// Checks that two films belong to the same image. Throws an Error for the first difference in size or in one of the
/// settings of `expected`; its message contains `name`, the value found and the value expected.
void check_same_image(const std::string& name, const StoredFilm& found, const StoredFilm& expected);

} // namespace duet
