// This fuzz target reads any bytes as a film. A film that is read must be written and read again to the same samples.
#include "raytrace/film/film_file.h"
#include "tests/fuzz/require.h"
#include "tests/support/errors.h"
#include "tests/support/scratch.h"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
    static const duet::test::ScratchFolder folder;
    duet::write_file(folder / "film.exr", {reinterpret_cast<const char*>(data), size});
    duet::test::error_of([] {
        const duet::StoredFilm film = duet::read_film(folder / "film.exr");
        duet::write_film(folder / "again.exr", film);
        const duet::StoredFilm again = duet::read_film(folder / "again.exr");
        duet::check_same_image("again.exr", again, film);
        duet::require(again.first_sample == film.first_sample);
        for (int y = 0; y < film.film.height(); ++y)
            for (int x = 0; x < film.film.width(); ++x) {
                const duet::Film::Pixel &read = film.film.pixels()(x, y), &twice = again.film.pixels()(x, y);
                duet::require(read.sum == twice.sum && read.count == twice.count && read.invalid == twice.invalid &&
                              read.target == twice.target);
            }
    });
    return 0;
}
