// Implements `raytrace merge`, which merges the films of a rendering's shards.
#pragma once

#include "raytrace/film/film_file.h"

#include <string>
#include <vector>

namespace duet::raytrace {

/// Holds a film and the name of its file.
struct NamedFilm {
    std::string name;
    StoredFilm stored;
};

/// Returns the sums of all films, added in the order of their samples. Throws Error, naming the files, if there are
/// none, if they are films of different images, or if they share samples.
StoredFilm merge_films(std::vector<NamedFilm> films);

/// Runs `raytrace merge -o OUT FILM…`, where argv[0] is "merge". Returns the exit code.
int run_merge(int argc, char** argv);

} // namespace duet::raytrace
