#include "compare/peers/export_scene.h"

#include "common/image/image_file.h"
#include "common/medium/density_grid.h"
#include "common/program/statistics.h"
#include "common/system/file.h"
#include "compare/peers/export_geometry.h"
#include "compare/peers/export_materials.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

namespace duet::compare {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// Returns the number of rings per sphere, from 16 to 128, such that all spheres together have at most 2^21
/// triangles if possible. Cycles sums over emissive triangles in float; with 65 million of them (the lights of
/// lanterns.json at 128 rings) it loses 3 % of the light. With 16 rings the silhouette is within 1 % of the
/// radius.
int sphere_rings(std::int64_t spheres) {
    constexpr std::int64_t kMaxTriangles = std::int64_t{1} << 21;
    int rings = 128;
    while (rings > 16 && sphere_triangle_count(rings) * spheres > kMaxTriangles) rings -= 2;
    return rings;
}

json vec_json(Vec3d v) { return {v.x, v.y, v.z}; }
json matrix_json(const Mat4d& m) {
    json rows = json::array();
    for (std::size_t r = 0; r < 4; ++r) rows.push_back(m[r]);
    return rows;
}

class SceneExport {
public:
    SceneExport(const fs::path& folder, const Scene& scene, const View& view, const ExportSettings& settings)
        : folder_(folder), scene_(scene), view_(view), settings_(settings) {}

    ExportNotes run() {
        if (settings_.depth < 1) fail_unsupported(scene_, "paths of depth 0: the peer scatters at least once");
        const fs::path geometry = folder_ / "geometry.bin";
        geometry_.open(geometry, std::ios::binary);
        json file = {
            {"materials", export_materials(folder_, scene_, notes_)},
            {"lights", lights()},
            {"environment", environment()},
            {"media", media()},
            {"camera", camera()}};
        add_objects(file);
        file["render"] = {{"width", view_.width},
                          {"height", view_.height},
                          {"depth", settings_.depth},
                          {"threads", settings_.threads}};
        geometry_.close();
        check_written(geometry_, geometry);
        write_json(folder_ / "scene.json", file);
        return {notes_.begin(), notes_.end()};
    }

private:
    // Light ----------------------------------------------------------------------------------------------------------

    json lights() const {
        json list = json::array();
        for (std::size_t i = 0; i < scene_.first_surface_light; ++i) {
            const Light& light = scene_.lights[i];
            if (const auto* point = std::get_if<PointLight>(&light)) {
                if (!is_black(point->intensity))
                    list.push_back({{"type", "point"},
                                    {"position", vec_json(Vec3d(point->position))},
                                    {"color", rgb_json(point->intensity)}});
            } else if (const auto* sun = std::get_if<SunLight>(&light)) {
                if (!is_black(sun->irradiance))
                    list.push_back({{"type", "sun"},
                                    {"direction", vec_json(Vec3d(sun->direction))},
                                    {"color", rgb_json(sun->irradiance)}});
            } else if (const auto* spot = std::get_if<SpotLight>(&light)) {
                if (spot->cos_outer < 0) fail_unsupported(scene_, "a spot light wider than a half-space");
                if (!is_black(spot->intensity))
                    list.push_back({{"type", "spot"},
                                    {"position", vec_json(Vec3d(spot->position))},
                                    {"direction", vec_json(Vec3d(spot->direction))},
                                    {"color", rgb_json(spot->intensity)},
                                    {"cos_inner", spot->cos_inner},
                                    {"cos_outer", spot->cos_outer}});
            }
        }
        return list;
    }

    json environment() const {
        if (const auto* constant = std::get_if<ConstantEnvironment>(&scene_.environment))
            return {{"type", "constant"}, {"radiance", rgb_json(constant->radiance)}};
        if (const auto* sky = std::get_if<SkyEnvironment>(&scene_.environment))
            return {{"type", "sky"}, {"down", rgb_json(sky->down)}, {"up", rgb_json(sky->up)}};
        // Cycles maps a direction with z up to u = ½ − atan2(y, x)/2π. Duet uses u = ½ + (atan2(x, −z) +
        // rotation)/2π. These rows rotate the direction before Cycles' mapping.
        const auto& image = std::get<ImageEnvironment>(scene_.environment);
        const double s = std::sin(static_cast<double>(image.rotation)),
                     c = std::cos(static_cast<double>(image.rotation));
        write_image(folder_ / "environment.exr", image.image);
        return {{"type", "image"},
                {"file", "environment.exr"},
                {"scale", image.scale},
                {"rows", {{-s, 0, -c}, {-c, 0, s}, {0, 1, 0}}}};
    }

    json media() {
        json list = json::array();
        for (const Medium& medium : scene_.media) {
            json m = {{"scattering", rgb_json(medium.scattering)},
                      {"absorption", rgb_json(medium.absorption)},
                      {"radiance", rgb_json(medium.radiance)},
                      {"asymmetry", medium.asymmetry},
                      {"box", nullptr},
                      {"density", nullptr}};
            const bool bounded = is_finite(medium.box.low) && is_finite(medium.box.high);
            const Box3 all = Medium::unbounded();
            if (!bounded && (medium.box.low != all.low || medium.box.high != all.high))
                fail_unsupported(scene_, "a medium with bounds on some sides alone");
            if (bounded) {
                m["box"] = json::array({vec_json(Vec3d(medium.box.low)), vec_json(Vec3d(medium.box.high))});
                if (!medium.density) notes_.insert("boxes of media are larger by 1e-4 of their size on each side");
            }
            if (medium.density) {
                m["density"] = {{"size", medium.density->size()}, {"values", write_array(medium.density->densities())}};
                notes_.insert("it marches through grids of density in steps, and fades them out beyond their box, "
                              "within a cell");
            }
            list.push_back(std::move(m));
        }
        const auto other = [&](const Medium& m) { return m.asymmetry != scene_.media.front().asymmetry; };
        // A numerical integration of single scattering agrees with Duet and not with Cycles.
        if (std::ranges::any_of(scene_.media, other))
            notes_.insert("where media of different asymmetry overlap, Cycles is off by some percent");
        if (!scene_.media.empty() && scene_.needs.transmission) notes_.insert("media are inside of glass, too");
        return list;
    }

    // Camera ---------------------------------------------------------------------------------------------------------

    json camera() const {
        const Camera& c = view_.camera;
        const Pinhole view = CameraModel(view_).pinhole();
        const bool orthographic = c.projection == Camera::Projection::kOrthographic;
        const Vec3d dx = orthographic ? view.origin_dx : view.direction_dx;
        const Vec3d right = normalize(dx), back = view.forward * -1.0, up = cross(back, right);
        const Vec3d eye(Vec3(c.eye)); // rounded as in CameraModel
        Mat4d m;
        for (std::size_t r = 0; r < 3; ++r) m[r] = {right[r], up[r], back[r], eye[r]};
        const double focus = c.focus_distance > 0 ? c.focus_distance : length(c.look_at - c.eye);
        return {{"matrix", matrix_json(m)},     {"near", view.near},
                {"orthographic", orthographic}, {"height", c.height},
                {"fov_degrees", c.fov_degrees}, {"aperture_radius", orthographic ? 0 : c.aperture_radius},
                {"focus_distance", focus}};
    }

    // Objects --------------------------------------------------------------------------------------------------------

    template <typename T> json write_array(const std::vector<T>& values) {
        constexpr std::size_t kNumber = 4; // floats and 32-bit integers, tightly packed
        static_assert(sizeof(T) % kNumber == 0);
        const auto offset = static_cast<std::uint64_t>(geometry_.tellp());
        const std::size_t bytes = values.size() * sizeof(T);
        geometry_.write(reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(bytes));
        return {offset, bytes / kNumber};
    }

    json mesh_json(const std::string& name, const TriangleSoup& soup) {
        return {{"name", name},
                {"positions", write_array(soup.positions)},
                {"triangles", write_array(soup.triangles)},
                {"slots", write_array(soup.slots)},
                {"normals", soup.normals.empty() ? json(nullptr) : write_array(soup.normals)},
                {"uvs", write_array(soup.uvs)},
                {"p_object", write_array(soup.object_positions)}};
    }

    Mat4 world_transform(const Object& object) const {
        if (!object.moving) return object.to_world;
        if (view_.camera.shutter_open != view_.camera.shutter_close)
            fail_unsupported(scene_, message("the object ", object.name, " moves while the shutter is open"));
        return object_transform(object, static_cast<float>(view_.camera.shutter_open)).to_world;
    }

    std::int64_t count_spheres() const {
        return std::ranges::count_if(scene_.objects, [&](const Object& o) {
            return std::holds_alternative<Sphere>(scene_.shapes[o.shape]);
        });
    }

    /// Adds the meshes of spheres. Most spheres share one mesh. A sphere that is so near or so large that the facets of
    /// that mesh would show has a mesh of its own.
    json add_sphere(const Object& o, const Sphere& sphere, json& meshes) {
        const Mat4d place = Mat4d(world_transform(o)) * translation(Vec3d(sphere.center));
        const auto radius = static_cast<double>(sphere.radius);
        const Vec3d eye = transform_point(inverse_affine(place), view_.camera.eye);
        const double height = std::abs(length(eye) / radius - 1); // distance above the surface, in radii
        constexpr double kLargestError = 2e-3; // largest error of facets, relative to their distance
        // Emitters always use the shared mesh, which has a sphere's area.
        const bool emits = emitter(scene_.materials[o.materials.front()]) != nullptr;
        if (!emits && 1 - std::cos(kPiDouble / (2 * rings_)) > kLargestError * height && length(eye) > 0) {
            notes_.insert("near spheres are meshes, off by at most 2e-4 of their distance; their textures have a seam");
            meshes.push_back(mesh_json(o.name, sphere_triangles_near(normalize(eye), height)));
            return {{"mesh", meshes.size() - 1},
                    {"matrix", matrix_json(place * scaling(Vec3d(radius, radius, radius)))}};
        }
        if (!sphere_mesh_) {
            notes_.insert(message("spheres are meshes of ", sphere_triangle_count(rings_),
                                  " triangles, of a sphere's area"));
            const TriangleSoup soup = sphere_triangles(rings_);
            sphere_mesh_ = {meshes.size(), std::sqrt(4 * kPiDouble / area(soup))};
            meshes.push_back(mesh_json("sphere", soup));
        }
        const double r = sphere_mesh_->radius * radius;
        return {{"mesh", sphere_mesh_->index}, {"matrix", matrix_json(place * scaling(Vec3d(r, r, r)))}};
    }

    json add_triangles(const Object& o, json& meshes) {
        const TriangleSoup soup = world_triangles(scene_.shapes[o.shape], world_transform(o));
        if (!soup.normals.empty())
            notes_.insert("smooth normals: the peer bends directions at their horizon in its own way");
        meshes.push_back(mesh_json(o.name, soup));
        return {{"mesh", meshes.size() - 1}, {"matrix", matrix_json(Mat4d())}};
    }

    void add_objects(json& file) {
        json meshes = json::array(), objects = json::array();
        for (const Object& o : scene_.objects) {
            const auto* sphere = std::get_if<Sphere>(&scene_.shapes[o.shape]);
            json object = sphere != nullptr ? add_sphere(o, *sphere, meshes) : add_triangles(o, meshes);
            object["name"] = o.name, object["materials"] = o.materials;
            objects.push_back(std::move(object));
        }
        file["meshes"] = std::move(meshes);
        file["objects"] = std::move(objects);
    }

    const fs::path& folder_;
    const Scene& scene_;
    const View& view_;
    const ExportSettings& settings_;
    std::ofstream geometry_;
    std::set<std::string> notes_;
    struct SharedMesh {
        std::size_t index;
        double radius; ///< radius at which the mesh has the area of a unit sphere
    };
    std::optional<SharedMesh> sphere_mesh_;
    const int rings_ = sphere_rings(count_spheres()); ///< of the shared mesh
};

} // namespace

ExportNotes export_scene(const fs::path& folder, const Scene& scene, const View& view, const ExportSettings& settings) {
    return SceneExport(folder, scene, view, settings).run();
}

} // namespace duet::compare
