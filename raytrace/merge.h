// `raytrace merge`: shards of a rendering, joined.
#pragma once

#include "common/film/film_file.h"

#include <string>
#include <vector>

namespace duet::raytrace {

/// A film and the name of the file that it is from.
struct NamedFilm {
    std::string name;
    KeptFilm kept;
};

/// The sums of all, added in the order of their samples. Throws Error, naming files, for none, films of different
/// pictures, and films that share samples.
KeptFilm merged(std::vector<NamedFilm> films);

/// The program's body: `raytrace merge -o OUT FILM…`, argv[0] being "merge". Returns its exit code.
int run_merge(int argc, char** argv);

} // namespace duet::raytrace
