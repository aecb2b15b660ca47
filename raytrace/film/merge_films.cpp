#include "raytrace/film/merge_films.h"

#include "common/image/image_file.h"
#include "common/program/command_line.h"
#include "common/program/program.h"
#include "common/program/view_transform_options.h"
#include "common/system/error.h"
#include "common/system/file_lock.h"

#include <algorithm>
#include <iostream>
#include <optional>

namespace duet::raytrace {

namespace {

void add(Film& film, const Film& other) {
    for (std::size_t i = 0; i < film.pixels().size(); ++i) {
        Film::Pixel& to = film.pixels()[i];
        const Film::Pixel& from = other.pixels()[i];
        for (std::size_t r = 0; r < Film::kReplicates; ++r) {
            to.sum[r] += from.sum[r];
            to.count[r] += from.count[r];
        }
        to.invalid += from.invalid;
        to.target = to.samples_taken();
    }
}

// Returns whether a single run could have rendered the merged film: every pixel has the same samples, and none is
// missing.
bool is_contiguous(const std::vector<NamedFilm>& films) {
    std::uint64_t next = films.front().stored.first_sample;
    for (const NamedFilm& film : films) {
        const std::uint32_t least = film.stored.film.min_samples_taken();
        if (film.stored.first_sample != next || least != film.stored.film.max_samples_taken()) return false;
        next += least;
    }
    return true;
}

void sort_by_samples(std::vector<NamedFilm>& films) {
    std::stable_sort(films.begin(), films.end(), [](const NamedFilm& a, const NamedFilm& b) {
        return a.stored.first_sample < b.stored.first_sample;
    });
}

struct Options {
    std::string output, film;
    std::vector<std::string> films;
    ViewTransformOptions view_transform;
    bool quiet = false;
};

int merge(const Options& options) {
    check_writable_image(options.output);
    std::optional<FileLock> lock;
    if (!options.film.empty()) lock.emplace(options.film);
    std::vector<NamedFilm> films;
    for (const std::string& name : options.films) films.push_back({name, read_film(name)});
    sort_by_samples(films);
    const bool contiguous = is_contiguous(films);
    const std::size_t count = films.size();
    const StoredFilm all = merge_films(std::move(films));
    if (!options.film.empty() && !contiguous)
        throw Error("--film: the films leave out samples, or some pixels have more than others: the whole could not be "
                    "continued (the image alone can be written)");
    if (!options.film.empty()) write_film(options.film, all);
    write_image(options.output, all.film.image(), {.view = options.view_transform.applied_to({})});
    if (options.quiet) return kExitOk;
    std::cerr << options.output << ": " << all.film.width() << " x " << all.film.height() << ", " << count << " films, "
              << all.film.min_samples_taken() << (contiguous ? "" : " or more") << " samples per pixel";
    if (const double error = all.film.estimated_relmse(); error >= 0) std::cerr << ", estimated relMSE " << error;
    std::cerr << '\n';
    return kExitOk;
}

} // namespace

StoredFilm merge_films(std::vector<NamedFilm> films) {
    if (films.empty()) throw Error("no film to merge");
    sort_by_samples(films);
    StoredFilm result = std::move(films.front().stored);
    std::uint64_t end = std::uint64_t{result.first_sample} + result.film.max_samples_taken();
    for (std::size_t i = 1; i < films.size(); ++i) {
        const auto& [name, stored] = films[i];
        check_same_image(name, stored, result);
        if (stored.first_sample < end)
            throw Error(message(name, ": has samples from ", stored.first_sample, " on, but ", films[i - 1].name,
                                " has those up to ", end - 1, ": expected films that share none"));
        end = std::uint64_t{stored.first_sample} + stored.film.max_samples_taken();
        add(result.film, stored.film);
    }
    return result;
}

int run_merge(int argc, char** argv) {
    return run_program("raytrace merge", [&] {
        CommandLine command_line("raytrace merge",
                                 "Joins films of the same image, of different samples, into one image.");
        command_line.set_footer("Example: two computers render half of the samples each:\n"
                                "  raytrace models/cornell.json -o a.png --samples 0:128 --film a.exr\n"
                                "  raytrace models/cornell.json -o b.png --samples 128:256 --film b.exr\n"
                                "  raytrace merge -o cornell.png a.exr b.exr\n\n"
                                "Exit codes: 0 done, 1 failed, 2 unusable arguments or input.");
        Options options;
        command_line.add("FILM", options.films, "Films that raytrace --film has written").required();
        command_line.add("-o,--output", options.output, "The image: .png, .jpg, .tga, .ppm, .pfm, .hdr or .exr")
            .required();
        command_line.add("--film", options.film,
                         "Write the joint film, too: it can be continued, or joined with others");
        add_view_transform(command_line, options.view_transform);
        command_line.add_flag("--quiet", options.quiet, "No summary");
        const std::optional<int> exit_code = command_line.parse(argc, argv);
        return exit_code ? *exit_code : merge(options);
    });
}

} // namespace duet::raytrace
