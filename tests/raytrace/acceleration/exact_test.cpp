// These tests compare the BVH's results with an independent tracer that tests every primitive in extended precision.
#include "raytrace/acceleration/accelerator.h"
#include "tests/raytrace/acceleration/soup.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

using namespace duet;
using namespace duet::raytrace;

namespace {

using Real = long double; // 64 bits of mantissa on x86, no fewer than double's 53 elsewhere
using Vec = Vec3T<Real>;

Real size_of(const Vec& v) { return std::sqrt(dot(v, v)); }
Real largest(const Vec& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

struct Line {
    Vec origin, direction;
    Real t_min, t_max;
    explicit Line(const Ray& ray) : origin(ray.origin), direction(ray.direction), t_min(ray.t_min), t_max(ray.t_max) {}
    Vec at(Real t) const { return origin + direction * t; }
    Real speed() const { return size_of(direction); }
    // Returns the world-space effect of about thirty single-precision rounding errors at distance t.
    Real room(Real t) const { return Real(32) * Real(0x1p-24) * (largest(origin) + std::abs(t) * speed()); }
};

Real distance_to_segment(const Vec& p, const Vec& a, const Vec& b) {
    const Vec along = b - a;
    const Real size = dot(along, along);
    const Real s = size > 0 ? std::clamp(dot(p - a, along) / size, Real(0), Real(1)) : Real(0);
    return size_of(a + along * s - p);
}

// Describes the intersection of a line with a primitive.
struct Meeting {
    Real clearance; // distance of the line inside the silhouette, perpendicular to the line; negative: distance outside
    Real t = 0;     // of the intersection; meaningful if the clearance is positive
    Real cosine = 0;
    Real nearest = 0; // no point of the primitive has a smaller t
};

// Represents a convex planar polygon or a sphere, in world space.
class Primitive {
public:
    std::uint32_t object, number;
    Real looseness = 1; // factor on the tolerance: larger for instances, whose hits come from a transformed ray
    std::vector<Vec> corners;
    Vec center;
    Real radius = 0;

    Meeting meet(const Line& line, Real after) const { return corners.empty() ? sphere(line, after) : polygon(line); }

    Real distance(const Vec& p) const {
        if (corners.empty()) return std::abs(size_of(p - center) - radius);
        Real best = std::numeric_limits<Real>::infinity();
        bool inside = true;
        const Vec n = normal();
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const Vec& a = corners[i];
            const Vec& b = corners[(i + 1) % corners.size()];
            best = std::min(best, distance_to_segment(p, a, b));
            inside = inside && dot(cross(b - a, p - a), n) >= 0;
        }
        return inside && size_of(n) > 0 ? std::abs(dot(p - corners[0], n)) / size_of(n) : best;
    }

private:
    Vec normal() const { return cross(corners[1] - corners[0], corners.back() - corners[0]); }

    Meeting polygon(const Line& line) const {
        const Vec d = line.direction * (1 / line.speed()), n = normal();
        Meeting meeting{};
        Real rim = std::numeric_limits<Real>::infinity();
        bool left = true, right = true;
        meeting.nearest = rim;
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const Vec from = corners[i] - line.origin, to = corners[(i + 1) % corners.size()] - line.origin;
            const Vec a = from - d * dot(from, d), b = to - d * dot(to, d); // perpendicular to the line
            rim = std::min(rim, distance_to_segment(Vec(), a, b));
            const Real side = dot(cross(a, b), d);
            left = left && side >= 0;
            right = right && side <= 0;
            meeting.nearest = std::min(meeting.nearest, dot(from, d) / line.speed());
        }
        const Real slope = dot(n, line.direction);
        meeting.clearance = (left || right) && slope != 0 ? rim : -rim;
        meeting.t = slope != 0 ? dot(n, corners[0] - line.origin) / slope : 0;
        meeting.cosine = size_of(n) > 0 ? std::abs(slope) / (size_of(n) * line.speed()) : 0;
        return meeting;
    }

    // Returns the first intersection beyond `after`.
    Meeting sphere(const Line& line, Real after) const {
        const Real a = dot(line.direction, line.direction), b = dot(center - line.origin, line.direction) / a;
        const Real aside = size_of(line.at(b) - center);
        const Real half = std::sqrt(std::max(radius * radius - aside * aside, Real(0)) / a);
        Meeting meeting{radius - aside, b - half, half * line.speed() / radius, b - radius / line.speed()};
        if (!(meeting.t > after)) meeting.t = b + half;
        return meeting;
    }
};

std::vector<Primitive> primitives_of(const Scene& scene, float time) {
    std::vector<Primitive> all;
    for (std::uint32_t o = 0; o < scene.objects.size(); ++o) {
        const Object& object = scene.objects[o];
        const bool placed = !object.identity || object.moving;
        const Mat4T<Real> map(object_transform(object, time).to_world);
        const Shape& shape = scene.shapes[object.shape];
        for (std::uint32_t p = 0; p < primitive_count(shape); ++p) {
            Primitive primitive{o, p, placed ? Real(8) : Real(1), {}, {}, 0};
            if (const auto* sphere = std::get_if<Sphere>(&shape)) {
                if (placed) continue; // a transformed sphere is an ellipsoid; instanced spheres have separate tests
                primitive.center = Vec(sphere->center);
                primitive.radius = sphere->radius;
            } else if (const auto* list = std::get_if<QuadList>(&shape)) {
                for (const Vec3& corner : corners(list->quads[p])) primitive.corners.push_back(Vec(corner));
            } else {
                const auto& mesh = std::get<Mesh>(shape);
                for (const std::uint32_t v : mesh.triangles[p])
                    primitive.corners.push_back(transform_point(map, Vec(mesh.positions[v])));
            }
            all.push_back(std::move(primitive));
        }
    }
    return all;
}

struct Verdicts {
    int rays = 0, hits = 0, mismatches = 0, ties = 0, edges = 0, wrong_shadows = 0, shown_duplicates = 0;
    std::string first;
};

// Checks the accelerator's result for a ray against the results of all primitives, one by one.
class Examiner {
public:
    Examiner(const std::vector<Primitive>& primitives, const Ray& ray)
        : primitives_(primitives), ray_(ray), line_(ray) {
        for (const Primitive& p : primitives) meetings_.push_back(p.meet(line_, line_.t_min));
    }

    void examine(const Hit& hit, Verdicts& verdicts) const {
        ++verdicts.rays;
        verdicts.hits += hit.valid();
        const std::size_t answer = index_of(hit), none = primitives_.size();
        if (hit.valid() && (answer == none || !lies_at(answer, hit.t)))
            return mismatch(hit, "it is not there", verdicts);
        const Real t = hit.valid() ? Real(hit.t) : line_.t_max;
        bool edge = answer != none && !surely_hit(answer), tie = false;
        for (std::size_t i = 0; i < primitives_.size(); ++i) {
            if (i == answer || !surely_hit(i)) continue;
            const Real slack = along(i, meetings_[i].t) + (answer != none ? along(answer, t) : 0);
            if (meetings_[i].t < t - slack) return mismatch(hit, described(i), verdicts);
            if (answer == none || meetings_[i].t > t + slack) continue;
            tie = true;
            // If two primitives are identical, the one with the lower index must be reported.
            const bool same = meetings_[i].t == meetings_[answer].t &&
                              primitives_[i].corners == primitives_[answer].corners &&
                              primitives_[i].center == primitives_[answer].center && surely_hit(answer);
            verdicts.shown_duplicates += same;
            const auto name = [&](std::size_t k) { return std::pair(primitives_[k].object, primitives_[k].number); };
            if (same && name(i) < name(answer))
                return mismatch(hit, "its duplicate is lower: " + described(i), verdicts);
        }
        verdicts.edges += edge;
        verdicts.ties += tie;
    }

    void examine_shadow(Real end, bool blocked, Verdicts& verdicts) const {
        bool must = false, may = false;
        for (std::size_t i = 0; i < primitives_.size(); ++i) {
            const Real slack = along(i, meetings_[i].t);
            must = must || (surely_hit(i) && meetings_[i].t + slack < end);
            const Real room = primitives_[i].looseness * line_.room(end);
            may = may || (meetings_[i].clearance > -room && meetings_[i].nearest - room / line_.speed() < end);
        }
        verdicts.wrong_shadows += blocked ? !may : must;
    }

private:
    std::size_t index_of(const Hit& hit) const {
        for (std::size_t i = 0; i < primitives_.size(); ++i)
            if (primitives_[i].object == hit.object && primitives_[i].number == hit.primitive) return i;
        return primitives_.size();
    }
    // Returns the range of t by which rounding may move a hit.
    Real along(std::size_t i, Real t) const {
        return primitives_[i].looseness * line_.room(t) / (std::max(meetings_[i].cosine, Real(1e-6)) * line_.speed());
    }
    bool surely_hit(std::size_t i) const {
        const Meeting& m = meetings_[i];
        const Real room = primitives_[i].looseness * line_.room(m.t), slack = along(i, m.t);
        // A sphere's first intersection must not be at the ray's start.
        const bool at_start =
            primitives_[i].corners.empty() && std::abs(primitives_[i].distance(line_.at(line_.t_min))) < room;
        return m.clearance > room && m.t > line_.t_min + slack && m.t < line_.t_max - slack && !at_start;
    }
    bool lies_at(std::size_t i, float t) const {
        return t > ray_.t_min && t <= ray_.t_max &&
               primitives_[i].distance(line_.at(t)) <= primitives_[i].looseness * line_.room(t);
    }
    std::string described(std::size_t i) const {
        return message("object ", primitives_[i].object, " primitive ", primitives_[i].number, " is met at ",
                       meetings_[i].t, ", ", meetings_[i].clearance, " within its polygon");
    }
    void mismatch(const Hit& hit, const std::string& why, Verdicts& verdicts) const {
        if (verdicts.mismatches++ == 0) verdicts.first = raytrace::described(hit) + ": " + why;
    }

    const std::vector<Primitive>& primitives_;
    const Ray& ray_;
    Line line_;
    std::vector<Meeting> meetings_;
};

Scene instanced_triangles(Soup& soup) {
    SceneBuilder builder;
    const std::uint32_t grey = builder.material(Diffuse{});
    builder.add(soup.triangles(60, 0.3f), grey);
    Soup own{soup.random, 1, {}};
    const std::uint32_t mesh = builder.shape(own.triangles(30, 0.5f));
    for (int i = 0; i < 12; ++i)
        builder.place(mesh, grey,
                      translation(soup.point()) * rotation(soup.random.direction(), soup.random.uniform(0, 6)) *
                          scaling(Vec3(1, soup.random.uniform(-1, -0.5f), 0.5f) *
                                  (soup.scale * soup.random.uniform(0.1f, 0.5f))));
    return builder.finish();
}

// Rays start inside or far from the scene with any direction, or are parallel to axes and planes with zeros of both
// signs. The third kind is parallel, too, but starts where it hits a vertex exactly.
enum class Kind { kAnywhere, kParallel, kParallelToVertices };

Ray ray_of(Kind kind, Soup& soup, const Scene& scene, int trial) {
    Ray ray = soup.ray(scene, 2 + trial % 2);
    if (kind == Kind::kParallel) ray.origin = soup.point();
    if (kind == Kind::kAnywhere) {
        ray.origin = trial % 2 ? soup.point() : soup.offset + soup.random.direction() * (soup.scale * 4);
        ray.direction = normalize_scaled(soup.point() - ray.origin);
    }
    ray.time = 0;
    // Some directions are not of length 1, and some rays have a limited range.
    if (trial % 5 == 1) ray.direction = ray.direction * std::pow(10.0f, soup.random.uniform(-6, 6));
    if (trial % 7 == 1) ray.t_max = soup.random.uniform(0.1f, 4) * soup.scale / length(ray.direction);
    if (trial % 7 == 2) ray.t_min = soup.random.uniform(0.1f, 2) * soup.scale / length(ray.direction);
    return ray;
}

Verdicts examine(const Scene& scene, Soup& soup, Kind kind, int trials) {
    const Accelerator accelerator(scene, 2);
    const std::vector<Primitive> primitives = primitives_of(scene, 0);
    std::vector<Ray> rays;
    for (int trial = 0; trial < trials; ++trial) rays.push_back(ray_of(kind, soup, scene, trial));
    std::vector<Hit> in_bulk(rays.size());
    accelerator.closest(rays, in_bulk);
    Verdicts verdicts;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Examiner examiner(primitives, rays[i]);
        const Hit hit = accelerator.closest(rays[i]);
        examiner.examine(hit, verdicts);
        verdicts.mismatches += !(hit == in_bulk[i]);
        Hit end;
        end.t = min(rays[i].t_max, soup.random.uniform(0.1f, 6) * soup.scale / length(rays[i].direction));
        examiner.examine_shadow(end.t, accelerator.occluded(rays[i], end), verdicts);
    }
    return verdicts;
}

} // namespace

TEST_SUITE("unit") {
    TEST_CASE(
        "rays hit what an independent tracer of higher precision hits, but for ties and for polygons met exactly") {
        for (const bool instances : {false, true})
            for (const Kind kind : {Kind::kAnywhere, Kind::kParallel, Kind::kParallelToVertices})
                for (const float scale : {1e-6f, 1.0f, 1e6f})
                    for (const float shift : {0.0f, 30.0f, 1000.0f}) {
                        CAPTURE(instances);
                        CAPTURE(static_cast<int>(kind));
                        CAPTURE(scale);
                        CAPTURE(shift);
                        Soup soup{Random(71), scale, Vec3(1, -0.5f, 0.25f) * (shift * scale)};
                        const Scene scene = instances ? instanced_triangles(soup) : soup.scene(false);
                        const Verdicts found = examine(scene, soup, kind, 800);
                        CHECK_MESSAGE(found.mismatches == 0, found.first);
                        CHECK(found.wrong_shadows == 0);
                        CHECK(found.hits > 150);
                        CHECK(found.shown_duplicates > 0);
                        // Rays that pass so close to a silhouette that rounding decides are no evidence. They are few
                        // unless the rays aim at vertices.
                        const double share = shift < 100 ? 0.03 : instances ? 0.4 : 0.25;
                        if (kind != Kind::kParallelToVertices) CHECK(found.edges < share * found.hits);
                        // Ties are rare except among duplicates.
                        if (shift < 100) CHECK(found.ties - found.shown_duplicates <= 0.03 * found.hits);
                    }
    }

    TEST_CASE("the independent tracer tells right from wrong") {
        Soup soup{Random(73), 1, {}};
        const Scene scene = soup.scene(false);
        const Accelerator accelerator(scene, 1);
        const std::vector<Primitive> primitives = primitives_of(scene, 0);
        Verdicts moved, lost, renamed, shadows;
        int hits = 0;
        for (int trial = 0; trial < 500; ++trial) {
            const Ray ray = ray_of(Kind::kAnywhere, soup, scene, 35 * trial); // with unlimited range and length 1
            const Hit hit = accelerator.closest(ray);
            if (!hit.valid()) continue;
            ++hits;
            const Examiner examiner(primitives, ray);
            Hit other = hit;
            other.t *= 1.0001f;
            examiner.examine(other, moved);
            examiner.examine(Hit{}, lost);
            other = hit;
            other.primitive ^= 1;
            examiner.examine(other, renamed);
            examiner.examine_shadow(Real(2) * hit.t, false, shadows);
        }
        CHECK(hits > 200);
        CHECK(moved.mismatches > 0.9 * hits);
        CHECK(lost.mismatches > 0.98 * hits);
        CHECK(renamed.mismatches > 0.9 * hits);
        CHECK(shadows.wrong_shadows > 0.98 * hits);
    }
}
