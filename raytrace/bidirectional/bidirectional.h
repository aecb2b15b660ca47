// Bidirectional path tracing joins paths from the camera with paths from the lights. Each light path is one that a
// plain path tracer would hardly find, as the light of a caustic (Veach 1997, §10; Lafortune and Willems 1993).
#pragma once

#include "raytrace/bidirectional/camera_projection.h"
#include "raytrace/bidirectional/light_emission.h"
#include "raytrace/bidirectional/subpath.h"

#include <deque>
#include <vector>

namespace duet::raytrace {

/// Holds light that a light subpath sends to the camera, to whichever pixel sees it.
struct Splat {
    std::uint32_t pixel; ///< row · width + column
    Rgb light;
};

/// Traces pairs of a camera subpath and a light subpath, one pair after the other.
class BidirectionalTracer {
public:
    /// Refers to all arguments.
    BidirectionalTracer(const RenderPlan& plan, const LightEmission& emission, const View& view, RayCounts& counts)
        : plan_(plan), emission_(emission), view_(view), counts_(counts) {}

    /// Returns the light that the camera ray brings, whose first hit is given and may be invalid. `pinhole` is the view
    /// through the ray's lens point. Appends to `splats` what the light subpath sends to pixels: there is one light
    /// subpath per pixel of the image, and the splats are weighted for that.
    Rgb trace(const Ray& ray, const Hit& hit, const Pinhole& pinhole, Sampler& sampler, std::vector<Splat>& splats);

private:
    void trace_light_subpath(const Pinhole& pinhole, float time, Sampler& sampler, std::vector<Splat>& splats);
    void connect_to_camera(const SubpathVertex& at, const Pinhole& pinhole, std::vector<Splat>& splats);
    Rgb trace_camera_subpath(Ray ray, Hit hit, const Pinhole& pinhole, Sampler& sampler);
    ScatteringT<float> leave(const SubpathVertex& at, const VertexRandomSamples& u, TransportMode mode,
                             PathThroughputT<float>& path, MisSums& sums);
    Rgb environment_light(Vec3 w, int depth, const LightReceiver& previous, const MisSums& sums) const;
    Rgb emitted_light(const SubpathVertex& at, int depth, float distance, const LightReceiver& previous) const;
    Rgb light_sample(const SubpathVertex& at, const VertexRandomSamples& u);
    Rgb connection(const SubpathVertex& camera, const SubpathVertex& light);
    bool visible(const Vertex& from, const Vertex& to, Vec3 w);
    double path_count() const { return static_cast<double>(view_.width) * static_cast<double>(view_.height); }

    const RenderPlan& plan_;
    const LightEmission& emission_;
    const View& view_;
    RayCounts& counts_;
    std::deque<SubpathVertex> light_subpath_; ///< connections end at all of its vertices that are not specular
};

} // namespace duet::raytrace
