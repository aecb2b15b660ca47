// Declares bidirectional path tracing, which connects subpaths from the camera with subpaths from the lights. They find
// light that a path tracer hardly finds, such as caustics (Veach 1997, §10; Lafortune and Willems 1993). Vertex
// connection and merging also merges vertices of the two subpaths that are close (Georgiev et al. 2012; Hachisuka et
// al. 2012). It finds caustics in a mirror, too, where no vertices can be connected. Merging blurs light over a radius,
// which shrinks with every sample. Progressive photon mapping connects nothing: a camera subpath merges with photons at
// its vertices, up to the first that scatters light diffusely (Hachisuka and Jensen 2009; Knaus and Zwicker 2011).
#pragma once

#include "raytrace/bidirectional/camera_projection.h"
#include "raytrace/bidirectional/light_emission.h"
#include "raytrace/bidirectional/photon_map.h"

#include <deque>
#include <vector>

namespace duet::raytrace {

/// Holds light that a light subpath sends to a pixel of the image.
struct Splat {
    std::uint32_t pixel; ///< row · width + column
    Rgb light;
};

/// Traces pairs of a camera subpath and a light subpath, one pair after the other. There is one light subpath per pixel
/// of the image, which determines the weight of its light. Random samples come from S, which is Sampler or
/// PrimarySample.
class BidirectionalTracer {
public:
    /// Keeps references to all arguments. `radius` is the radius of merging; with 0, subpaths do not merge.
    BidirectionalTracer(const RenderPlan& plan, const LightEmission& emission, const View& view, Integrator integrator,
                        float radius, RayCounts& counts);

    /// Traces the light subpath of a sample, which replaces the previous one. `time` is that of the sample's camera
    /// ray.
    template <typename S> void trace_light_subpath(float time, S& sampler);
    /// Appends the light that the light subpath sends to pixels. `pinhole` is the view through the sample's lens point.
    void connect_to_camera(const Pinhole& pinhole, std::vector<Splat>& splats);
    /// Appends the photons of the light subpath. There is none at its first hit, because light samples find direct
    /// light.
    void add_photons(std::vector<Photon>& photons) const;
    /// Returns the radiance along a camera ray, whose first hit is given and may be invalid. It includes the
    /// connections with the light subpath and, if `photons` is not null, the photons nearby. In photon mapping no light
    /// subpath is necessary.
    template <typename S>
    Rgb trace_camera_subpath(Ray ray, Hit hit, const Pinhole& pinhole, S& sampler, const PhotonMap* photons);

private:
    std::optional<Splat> connection_to_camera(const SubpathVertex& at, const Pinhole& pinhole);
    ScatteringT<float> leave(const SubpathVertex& at, const VertexRandomSamples& u, TransportMode mode,
                             PathThroughputT<float>& path, MisSums& sums);
    /// Selects the light that a camera subpath still has to find.
    enum class Wanted {
        kAll,
        kDirect, ///< photons have found all light at the last vertex, except direct light
        kRest,   ///< all other light is found, except of sources that emit no photons
    };
    Rgb environment_light(Vec3 w, int depth, const LightReceiver& previous, const MisSums& sums, Wanted wanted) const;
    Rgb emitted_light(const SubpathVertex& at, int depth, float distance, const LightReceiver& previous,
                      Wanted wanted) const;
    bool photons_bring(double bsdf_pdf) const;
    Rgb light_sample(const SubpathVertex& at, const VertexRandomSamples& u);
    Rgb connection(const SubpathVertex& camera, const SubpathVertex& light);
    Rgb merged_light(const SubpathVertex& at, const PhotonMap& photons) const;
    bool visible(const Vertex& camera, const SubpathVertex& light, Vec3 w);
    float photon_weight(const SubpathVertex& at, const Photon& photon) const;
    double merging_at(const SubpathVertex& light) const { return light.depth > 0 ? merging_ : 0; }
    double path_count() const { return static_cast<double>(view_.width) * static_cast<double>(view_.height); }

    const RenderPlan& plan_;
    const LightEmission& emission_;
    const View& view_;
    const bool connects_;
    const double merging_; ///< see MisSums
    RayCounts& counts_;
    std::deque<SubpathVertex> light_subpath_; ///< its non-specular vertices, which can be connected
};

} // namespace duet::raytrace
