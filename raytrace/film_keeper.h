// A render's film, and the file that keeps it while the render runs.
#pragma once

#include "common/film/film_file.h"
#include "common/system/stopwatch.h"
#include "raytrace/render.h"

#include <atomic>
#include <functional>
#include <mutex>
#include <shared_mutex>

namespace duet::raytrace {

/// Everything that decides the bits of a film's samples, but for their numbers: of which films can be continued by a
/// render, and joined with others.
std::vector<KeptFilm::Setting> film_settings(const Scene& scene, const View& view, const Settings& settings);

/// The film of one render. With Settings::film it begins as that file has it, if there is one, and is written there at
/// intervals and at the end; else it begins empty.
class FilmKeeper {
public:
    /// Throws Error for a file that is no film, or one of another picture or other samples.
    FilmKeeper(const Scene& scene, const View& view, const Settings& settings);

    Film& film() { return kept_.film; }

    /// Runs work that adds to some pixels, from any thread; then writes the film, if it is time.
    void add(const std::function<void()>& work);
    /// Writes the film. Throws Error (exit code 1) where that fails.
    void keep();

private:
    const std::filesystem::path path_; // empty: nothing is kept
    const double interval_;
    KeptFilm kept_;
    Stopwatch since_written_;
    std::shared_mutex at_rest_; // held by all who add, and by who looks at all pixels alone
    std::mutex writing_;
};

} // namespace duet::raytrace
