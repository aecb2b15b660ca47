// Films in files: kept while a render runs, continued by a later one, joined with those of other machines.
#pragma once

#include "common/film/film.h"

#include <filesystem>
#include <string>
#include <vector>

namespace duet {

/// A film, and what it is a film of.
struct KeptFilm {
    /// A setting that decides the samples, such as {"seed", "0"}.
    struct Setting {
        std::string name, value;
        friend bool operator==(const Setting&, const Setting&) = default;
    };

    Film film;
    std::vector<Setting> settings;  ///< of different names, in any order
    std::uint32_t first_sample = 0; ///< every pixel has samples from this one on, as many as Film::taken says
};

/// An EXR that any viewer shows: R, G and B are the means. Beside them lies all that the film keeps, exactly: each sum
/// of doubles as two channels of 32-bit integers, sumN.C.high and sumN.C.low (N the replicate, C of R, G, B), countN,
/// invalid and target; the settings are text attributes, `duet:film.NAME`. Whole or absent. Throws Error (exit code 1) where
/// writing fails.
void write_film(const std::filesystem::path& path, const KeptFilm& kept);

/// The same bits that were written. Throws Error naming the file and what is missing or wrong for one that is no film.
KeptFilm read_film(const std::filesystem::path& path);

/// Throws Error, naming the film and both values, for the first of size and settings in which `found` is not as
/// expected.
void check_same_picture(const std::string& name, const KeptFilm& found, const KeptFilm& expected);

} // namespace duet
