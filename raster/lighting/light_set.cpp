#include "raster/lighting/light_set.h"

namespace duet::raster {
namespace {

using Lanes = xsimd::batch_bool<float>;
constexpr float kHuge = 1e30f; ///< greater than all coordinates, in meters
constexpr std::size_t kBatch = Floats::size;
const Floats kNone(0.0f);

/// Holds the least and the greatest value of a dot product of vectors from two boxes.
struct Range {
    Floats low, high;
};
Range dot_range(const Vec3T<Floats>& a0, const Vec3T<Floats>& a1, const Vec3T<Floats>& b0, const Vec3T<Floats>& b1) {
    const auto axis = [&](Floats Vec3T<Floats>::*c) -> Range {
        const Floats p = a0.*c * b0.*c, q = a0.*c * b1.*c, r = a1.*c * b0.*c, s = a1.*c * b1.*c;
        return {min(min(p, q), min(r, s)), max(max(p, q), max(r, s))};
    };
    const Range x = axis(&Vec3T<Floats>::x), y = axis(&Vec3T<Floats>::y), z = axis(&Vec3T<Floats>::z);
    return {x.low + y.low + z.low, x.high + y.high + z.high};
}

} // namespace

void LightSet::resize(std::size_t count) {
    lights_.resize(count);
    stride_ = (count + kBatch - 1) / kBatch * kBatch;
    bounds_.resize(stride_ * kRows);
    for (std::size_t i = count; i < stride_; ++i)
        for (int r = 0; r < kRows; ++r) row(r)[i] = 0;
}

void LightSet::assign(const LightSet& other, std::span<const std::uint32_t> columns) {
    resize(columns.size());
    for (std::size_t i = 0; i < columns.size(); ++i) lights_[i] = other.lights_[columns[i]];
    for (std::size_t i = 0; i < stride_; i += kBatch) {
        const std::size_t count = std::min(kBatch, columns.size() - i);
        alignas(64) std::array<std::int32_t, kBatch> from{};
        std::copy_n(columns.begin() + static_cast<std::ptrdiff_t>(i), count, from.begin());
        const Lanes exists = load(kLanesAsFloats, 0) < Floats(static_cast<float>(count));
        for (int r = 0; r < kRows; ++r)
            xsimd::select(exists, gather(other.row(r), Ints::load_aligned(from.data())), kNone)
                .store_aligned(row(r) + i);
    }
}

LightSet::LightSet(std::span<const FrameLight> lights, const LightVisibility* shadows, bool sums) {
    resize(lights.size());
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const FrameLight& light = lights[i];
        lights_[i] = static_cast<std::uint32_t>(i);
        const auto set = [&](int r, float value) { row(r)[i] = value; };
        const auto set_vector = [&](int r, Vec3 v) { set(r, v.x), set(r + 1, v.y), set(r + 2, v.z); };
        constexpr float kSunDistance = 1e9f; // meters: far beyond every scene, while its square is still a float
        Vec3 low = light.position, high = light.position, axis;
        float plane = -1; // with axis 0, all points are in front
        const float power = average(light.emitted);
        float area = 1, most = kHuge;
        bool may_be_far = sums && (shadows == nullptr || shadows->source(light.index) == LightVisibility::kUnshadowed);
        set(kConeCosine, 0), set(kConeSine, 0);
        switch (light.kind) {
        case FrameLight::Kind::kTriangle:
        case FrameLight::Kind::kQuad: {
            const bool quad = light.kind == FrameLight::Kind::kQuad;
            const Vec3 opposite = quad ? light.u + light.v : Vec3();
            low += min(min(Vec3(), opposite), min(light.u, light.v));
            high += max(max(Vec3(), opposite), max(light.u, light.v));
            area = length(cross(light.u, light.v)) * (quad ? 1.0f : 0.5f), most = kPi * power;
            if (!light.two_sided) axis = light.axis, plane = dot(axis, light.position);
            may_be_far = may_be_far && !light.two_sided;
            break;
        }
        case FrameLight::Kind::kSphere: {
            const Vec3 reach(light.radius, light.radius, light.radius);
            low -= reach, high += reach;
            area = kPi * sqr(light.radius), most = kPi * power;
            break;
        }
        case FrameLight::Kind::kPoint:
            break;
        case FrameLight::Kind::kSpot:
            axis = light.axis, plane = light.cos_outer >= 0 ? dot(axis, light.position) : -kHuge;
            set(kConeCosine, light.cos_outer), set(kConeSine, safe_sqrt(1 - sqr(light.cos_outer)));
            may_be_far = false;
            break;
        case FrameLight::Kind::kSun:
            low = high = light.axis * kSunDistance;
            area = sqr(kSunDistance), most = power;
            may_be_far = false;
            break;
        }
        set_vector(kLowX, low), set_vector(kHighX, high), set_vector(kAxisX, axis), set(kPlane, plane);
        set(kRadius, length(high - low) * 0.5f), set(kIntensity, power * area), set(kMost, most);
        const Rgb intensity = may_be_far ? light.emitted * area : Rgb();
        set_vector(kRed, {intensity.r, intensity.g, intensity.b});
    }
}

void LightSet::reach(const SurfaceBounds& surfaces, float other_irradiance, LightsOfCluster& result) const {
    result.near.clear(), result.far.clear();
    result.error.resize(stride_), result.distant.resize(stride_), result.most.resize(stride_);
    const auto wide = [](Vec3 v) { return broadcast<Floats>(v); };
    const Vec3T<Floats> p_low = wide(surfaces.p_low), p_high = wide(surfaces.p_high), n_low = wide(surfaces.n_low),
                        n_high = wide(surfaces.n_high), p = wide(surfaces.center()), n = wide(surfaces.mean_normal());
    const Floats radius(length(surfaces.extent()));
    const bool divided = size() > kFewLights;
    Floats irradiance = kNone; // irradiance at the cluster's center
    for (std::size_t i = 0; i < stride_; i += kBatch) {
        const auto number = [&](int r) { return Floats::load_aligned(row(r) + i); };
        const auto vector = [&](int r) { return Vec3T<Floats>(number(r), number(r + 1), number(r + 2)); };
        const Vec3T<Floats> low = vector(kLowX), high = vector(kHighX), axis = vector(kAxisX);
        const Range above = dot_range(n_low, n_high, low - p_high, high - p_low);
        const Range front = dot_range(axis, axis, p_low, p_high);
        const Vec3T<Floats> to = (low + high) * Floats(0.5f) - p;
        const Floats squared = max(dot(to, to), Floats(1e-12f)), along = -dot(to, axis);
        const Floats outside = xsimd::sqrt(max(squared - along * along, kNone)) * number(kConeCosine) -
                               along * number(kConeSine); // signed distance from a spot's cone
        const Floats intensity = number(kIntensity), plane = number(kPlane);
        const Lanes reaches = (above.high > kNone) & (front.high > plane) & (outside <= radius) & (intensity > kNone);
        const Vec3T<Floats> zero(kNone, kNone, kNone), apart = max(max(low - p_high, p_low - high), zero);
        // If the light lies in the box, few surfaces are nearer to it than the box's radius.
        const Floats nearest = max(dot(apart, apart), max(radius * radius, Floats(1e-12f)));
        min(intensity / nearest, number(kMost)).store_aligned(result.most.data() + i);
        Floats error(kHuge);
        if (divided) {
            const Floats inverse = inverse_sqrt(squared), over = inverse * inverse;
            const Floats facing = max(xsimd::select(dot(axis, axis) > kNone, along * inverse, Floats(1.0f)), kNone);
            const Floats there = intensity * max(dot(to, n) * inverse, kNone) * facing * over;
            irradiance += xsimd::select(reaches, min(there, number(kMost)), kNone);
            // The field's error comes from the second derivative. For an inverse square it is at most 3 (radius /
            // distance)².
            const Floats extent = radius + number(kRadius), relative = extent * extent * over;
            constexpr float kNearest = 1.0f / 256; // (radius / distance)²; errors of adjacent lights add up
            const Lanes whole = (above.low > kNone) & (front.low > plane) & (relative < Floats(kNearest)) &
                                (max(number(kRed), max(number(kGreen), number(kBlue))) > kNone);
            error = xsimd::select(whole, Floats(3.0f) * relative * intensity * over, error);
        }
        xsimd::select(reaches, error, Floats(-1.0f)).store_aligned(result.error.data() + i);
    }
    const Floats allowed(divided ? kError * (xsimd::hadd(irradiance) + other_irradiance) : 0.0f);
    for (std::size_t i = 0; i < stride_; i += kBatch) {
        const Floats error = Floats::load_aligned(result.error.data() + i);
        const Lanes reaches = error >= kNone, far = reaches & (error < allowed);
        xsimd::select(far, Floats(1.0f), kNone).store_aligned(result.distant.data() + i);
        const auto add = [&](unsigned bits, std::vector<std::uint32_t>& to) {
            for (const std::size_t lane : SetBits(bits)) to.push_back(static_cast<std::uint32_t>(i + lane));
        };
        add(lane_bits(far), result.far), add(lane_bits(reaches) & ~lane_bits(far), result.near);
    }
    if (!result.far.empty()) result.field = sum(surfaces, result.distant);
}

void LightSet::choose(const LightsOfCluster& cluster, std::size_t most, float u,
                      std::vector<WeightedLight>& result) const {
    result.clear();
    if (cluster.near.size() <= most) {
        for (const std::uint32_t column : cluster.near) result.push_back({lights_[column], 1});
        return;
    }
    double sum = 0;
    for (const std::uint32_t column : cluster.near) sum += static_cast<double>(cluster.most[column]);
    const double step = sum / static_cast<double>(most);
    double next = static_cast<double>(u) * step, end = 0; // `end` is where the light's interval ends
    for (const std::uint32_t column : cluster.near) {
        const auto length = static_cast<double>(cluster.most[column]);
        end += length;
        int times = 0;
        for (; next < end; next += step) ++times;
        if (times > 0) result.push_back({lights_[column], static_cast<float>(times * step / length)});
    }
}

LightField LightSet::sum(const SurfaceBounds& surfaces, std::span<const float> distant) const {
    // The field is the linear function that interpolates its values at the corners of a tetrahedron in the box.
    constexpr std::array<Vec3, 4> kCorners{Vec3(1, 1, 1), Vec3(1, -1, -1), Vec3(-1, 1, -1), Vec3(-1, -1, 1)};
    constexpr float kInset = 0.577350269f; // 1/√3 balances the error at the box's corners against that inside
    const Vec3 extent = max(surfaces.extent() * kInset, Vec3(1e-6f, 1e-6f, 1e-6f));
    LightField field;
    field.center = surfaces.center(), field.inverse_extent = Vec3(1 / extent.x, 1 / extent.y, 1 / extent.z);
    for (const Vec3 corner : kCorners) {
        const Vec3T<Floats> p = broadcast<Floats>(field.center + extent * corner), none(kNone, kNone, kNone);
        std::array<Vec3T<Floats>, 3> sums{none, none, none};
        for (std::size_t i = 0; i < stride_; i += kBatch) {
            const Floats far = Floats::load_aligned(distant.data() + i);
            if (lane_bits(far > kNone) == 0) continue;
            const auto number = [&](int r) { return Floats::load_aligned(row(r) + i); };
            const auto vector = [&](int r) { return Vec3T<Floats>(number(r), number(r + 1), number(r + 2)); };
            const Vec3T<Floats> axis = vector(kAxisX), to = (vector(kLowX) + vector(kHighX)) * Floats(0.5f) - p;
            const Floats inverse = inverse_sqrt(max(dot(to, to), Floats(1e-12f)));
            const Floats facing = xsimd::select(dot(axis, axis) > kNone, -dot(to, axis) * inverse, Floats(1.0f));
            const Vec3T<Floats> incident = to * (far * facing * inverse * inverse * inverse);
            for (int c = 0; c < 3; ++c) sums[static_cast<std::size_t>(c)] += incident * number(kRed + c);
        }
        for (std::size_t c = 0; c < 3; ++c) {
            const Vec3 v = Vec3(xsimd::hadd(sums[c].x), xsimd::hadd(sums[c].y), xsimd::hadd(sums[c].z)) * 0.25f;
            std::array<Vec3, 4>& color = field.colors[c];
            color[0] += v, color[1] += v * corner.x, color[2] += v * corner.y, color[3] += v * corner.z;
        }
    }
    return field;
}

} // namespace duet::raster
