#include "raytrace/film/film_checkpoint.h"

#include "common/image/stored_image.h"
#include "common/sampling/digest.h"
#include "common/scene/scene_hash.h"
#include "common/system/error.h"
#include "common/system/file.h"

namespace duet::raytrace {

namespace {

std::string camera_hash(const Camera& camera) {
    const double numbers[] = {static_cast<double>(camera.projection),
                              camera.eye.x,
                              camera.eye.y,
                              camera.eye.z,
                              camera.look_at.x,
                              camera.look_at.y,
                              camera.look_at.z,
                              camera.up.x,
                              camera.up.y,
                              camera.up.z,
                              camera.fov_degrees,
                              camera.height,
                              camera.near,
                              camera.aperture_radius,
                              camera.focus_distance,
                              camera.shutter_open,
                              camera.shutter_close};
    return to_hex(hash_bytes(0, {reinterpret_cast<const char*>(numbers), sizeof numbers}));
}

// Returns all settings that determine the bits of a film's samples, except for the sample numbers. A render can
// continue a film, and films can be merged, only if these settings are equal.
std::vector<StoredFilm::Setting> film_settings(const Scene& scene, const View& view,
                                               const PathTracerSettings& settings) {
    std::vector<StoredFilm::Setting> all{
        {"scene", hash_scene_files(scene)},
        {"camera", camera_hash(view.camera)},
        {"program", message("raytrace ", DUET_VERSION, ", estimators ", kEstimatorVersion)},
        {"integrator", std::string(integrator_name(settings.integrator))},
        {"depth", std::to_string(settings.max_depth)},
        {"roulette", settings.russian_roulette ? "yes" : "no"},
        {"environment", settings.environment ? "yes" : "no"},
        {"sampler", std::string(sampler_name(settings.sampler))},
        {"filter", std::string(filter_name(settings.filter))},
        {"seed", std::to_string(settings.seed)},
        {"adaptive", settings.adaptive ? "yes" : "no"},
        {"replicates", std::to_string(settings.replicates())},
    };
    if (needs_sample_count(settings.sampler)) all.push_back({"samples", std::to_string(settings.samples_per_pixel)});
    return all;
}

// Returns the film in the file if the file exists, else an empty film.
StoredFilm load_or_create(const Scene& scene, const View& view, const PathTracerSettings& settings) {
    if (!settings.film.empty()) // fail now if the film will be too large to be read
        check_image_size(settings.film.string(), view.width, view.height);
    StoredFilm fresh{Film(view.width, view.height), {}, settings.first_sample};
    if (settings.film.empty()) return fresh;
    remove_interrupted_writes(settings.film); // left by killed renders; the film is locked
    fresh.settings = film_settings(scene, view, settings);
    if (!std::filesystem::exists(settings.film)) return fresh;
    StoredFilm stored = read_film(settings.film);
    const std::string name = settings.film.string();
    check_same_image(name, stored, fresh);
    if (stored.first_sample != settings.first_sample)
        throw Error(message(name, ": a film of samples from ", stored.first_sample, " on, expected from ",
                            settings.first_sample, " on"));
    return stored;
}

std::optional<FileLock> lock_of(const std::filesystem::path& film) {
    return film.empty() ? std::optional<FileLock>() : std::optional<FileLock>(std::in_place, film);
}

} // namespace

FilmCheckpoint::FilmCheckpoint(const Scene& scene, const View& view, const PathTracerSettings& settings)
    : path_(settings.film), interval_(settings.film_interval), lock_(lock_of(path_)),
      stored_(load_or_create(scene, view, settings)) {}

void FilmCheckpoint::run(const std::function<void()>& work) {
    {
        const std::shared_lock add_lock = [&] {
            const std::lock_guard wait_for_copy(entry_mutex_);
            return std::shared_lock(pixels_mutex_);
        }();
        work();
    }
    if (path_.empty()) return;
    const std::unique_lock write_lock(write_mutex_, std::try_to_lock); // fails while another thread writes the file
    if (!write_lock || since_write_.seconds() < interval_) return;
    save();
    since_write_.restart();
}

void FilmCheckpoint::save() {
    if (path_.empty()) return;
    const StoredFilm snapshot = [&] {
        const std::lock_guard stop_others(entry_mutex_);
        const std::unique_lock copy_lock(pixels_mutex_);
        return stored_;
    }();
    write_film(path_, snapshot); // other threads continue meanwhile
}

} // namespace duet::raytrace
