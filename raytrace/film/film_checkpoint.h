// Declares FilmCheckpoint, which owns the film of a render and saves it to a file while the render runs.
#pragma once

#include "common/scene/scene.h"
#include "common/system/file_lock.h"
#include "common/system/stopwatch.h"
#include "raytrace/film/film_file.h"
#include "raytrace/settings.h"

#include <functional>
#include <mutex>
#include <optional>
#include <shared_mutex>

namespace duet::raytrace {

/// Owns the film of one render. If PathTracerSettings::film names an existing file, it starts with that film, otherwise
/// with an empty one. It writes the film to that file at intervals and at the end.
class FilmCheckpoint {
public:
    /// Throws Error if the file is no film, is a film of another image or of other samples, or if another process
    /// works on it.
    FilmCheckpoint(const Scene& scene, const View& view, const PathTracerSettings& settings);

    Film& film() { return stored_.film; }
    const Film& film() const { return stored_.film; }

    /// Runs `work`, which adds to some pixels, then writes the film if the interval has passed. Any thread may call
    /// it.
    void run(const std::function<void()>& work);
    /// Writes the film if there is a file to write to. Throws Error (exit code 1) if writing fails.
    void save();

private:
    const std::filesystem::path path_; // empty: nothing is written
    const double interval_;
    std::optional<FileLock> lock_; // lock on path_, taken before the film is read
    StoredFilm stored_;
    Stopwatch since_write_;
    std::shared_mutex pixels_mutex_; // shared by threads that add to pixels, exclusive to copy all pixels
    std::mutex entry_mutex_;         // held to lock pixels_mutex_; else new readers could keep the copy waiting
    std::mutex write_mutex_;
};

} // namespace duet::raytrace
