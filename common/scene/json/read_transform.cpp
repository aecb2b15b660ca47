#include "common/scene/json/read_transform.h"

#include "common/scene/json/scene_keys.h"
#include "common/system/suggestion.h"

#include <algorithm>
#include <array>

namespace duet {

namespace {

Mat4d read_matrix(const JsonValue& value) {
    const std::vector<double> entries = value.numbers(16);
    Mat4d m;
    for (std::size_t i = 0; i < 16; ++i) m[i / 4][i % 4] = entries[i];
    if (m[3] != std::array<double, 4>{0, 0, 0, 1}) value.fail("the last row of a matrix must be 0, 0, 0, 1");
    return m;
}

Mat4d read_scale(const JsonValue& value) {
    const bool uniform = value.is(JsonNode::Kind::kNumber);
    const Vec3d s = uniform ? Vec3d(value.number(), value.number(), value.number()) : value.vec3();
    if (s.x == 0 || s.y == 0 || s.z == 0) value.fail("a scale of 0 makes the transform singular");
    return scaling(s);
}

Mat4d read_rotation(const JsonValue& step) {
    const Vec3d axis = step.at("axis").vec3();
    if (axis == Vec3d()) step.at("axis").fail("an axis must not be the zero vector");
    return rotation(normalize_scaled(axis), radians(step.at("rotate_degrees").number()));
}

Mat4d read_step(const JsonValue& step) {
    if (!step.is(JsonNode::Kind::kObject)) step.expected("an object such as {\"translate\": [x, y, z]}");
    for (const std::string_view kind : {"translate", "scale", "matrix"})
        if (step.has(kind)) {
            step.check_keys(scene_keys(kind));
            const JsonValue value = step.at(kind);
            return kind == "translate" ? translation(value.vec3())
                   : kind == "scale"   ? read_scale(value)
                                       : read_matrix(value);
        }
    if (step.has("rotate_degrees") || step.has("axis")) {
        step.check_keys(scene_keys("rotate"));
        return read_rotation(step);
    }
    const std::vector<std::string_view> known{"translate", "scale", "rotate_degrees", "matrix"};
    step.fail("expected one of the keys \"translate\", \"scale\", \"rotate_degrees\" with \"axis\", \"matrix\"" +
              (step.node().keys.empty() ? "" : suggestion(step.node().keys.front(), known)));
}

Mat4d read_list(const JsonValue& list) {
    Mat4d m;
    for (const JsonValue& step : list.elements()) m = read_step(step) * m;
    return m;
}

/// Returns the determinant divided by the product of the columns' lengths: ±1 for orthogonal columns, 0 for a
/// singular map.
double relative_determinant(const Mat4d& m) {
    double lengths = 1;
    for (std::size_t c = 0; c < 3; ++c) lengths *= length(Vec3d(m[0][c], m[1][c], m[2][c]));
    return lengths > 0 ? determinant3(m) / lengths : 0;
}

/// Returns the times in (0, 1) at which the determinant of the interpolated map, a cubic polynomial, has an extremum.
std::vector<double> critical_times(const MotionTransform& m) {
    const auto f = [&](double t) { return determinant3(lerp(m.start, m.end, t)); };
    // The cubic f(t) = f0 + b t + c t² + d t³ is interpolated at t = 0, ½, 1 and −1.
    const double f0 = f(0), f1 = f(1), fh = f(0.5), fm = f(-1);
    const double c = 0.5 * (f1 + fm) - f0;
    const double odd = 0.5 * (f1 - fm);                            // b + d
    const double d = (odd - 2 * (fh - f0 - 0.25 * c)) * (4.0 / 3); // solved from f(½)
    const double b = odd - d;
    std::vector<double> times;
    const double root = sqr(c) - 3 * b * d; // discriminant of f' = b + 2 c t + 3 d t²
    if (root < 0) return times;
    const double q = -c - std::copysign(std::sqrt(root), c);
    for (const double t : {q / (3 * d), b / q})
        if (t > 0 && t < 1) times.push_back(t); // NaN and infinity fail this test
    return times;
}

bool within_limits(const Mat4d& m) {
    const auto bounded = [](const Mat4d& a) {
        return std::all_of(a.m.begin(), a.m.end(), [](const std::array<double, 4>& row) {
            return std::all_of(row.begin(), row.end(), [](double x) { return std::abs(x) <= 1e18; });
        });
    };
    return bounded(m) && bounded(inverse_affine(m));
}

} // namespace

MotionTransform MotionTransform::operator*(const MotionTransform& inner) const {
    return {start * inner.start, end * inner.end, moving || inner.moving};
}

const char* transform_error(const MotionTransform& transform) {
    // Below this relative determinant the columns are coplanar in float precision, and normals and inverses would be
    // noise.
    constexpr double kSingular = 1e-7;
    if (!(std::abs(relative_determinant(transform.start)) > kSingular) ||
        !(std::abs(relative_determinant(transform.end)) > kSingular))
        return "the transform is singular";
    if (transform.moving) {
        const double start = determinant3(transform.start), end = determinant3(transform.end);
        const double least = 1e-9 * min(abs(start), abs(end)), sign = std::copysign(1.0, start);
        bool is_regular = sign * end > 0;
        for (const double t : critical_times(transform))
            is_regular = is_regular && sign * determinant3(lerp(transform.start, transform.end, t)) > least;
        if (!is_regular)
            return "the motion passes through a singular transform (matrix entries are interpolated: turn by less than "
                   "180 degrees)";
    }
    if (!within_limits(transform.start) || !within_limits(transform.end))
        return "the transform or its inverse has entries beyond 1e18";
    return nullptr;
}

MotionTransform read_motion(const JsonValue& object) {
    MotionTransform motion;
    if (object.has("transform")) motion.start = read_list(object.at("transform"));
    motion.end = object.has("transform_end") ? read_list(object.at("transform_end")) : motion.start;
    motion.moving = !(motion.start == motion.end);
    if (const char* error = transform_error(motion))
        object.at(object.has("transform_end") ? "transform_end" : "transform").fail(error);
    return motion;
}

} // namespace duet
