// Provides indirect diffuse light from a grid of probes. A probe stores the irradiance of all light but direct light,
// as spherical harmonics, and the distances of the surfaces around it, so that no light leaks through walls (Majercik
// et al. 2019, "Dynamic Diffuse Global Illumination with Ray-Traced Irradiance Fields").
#pragma once

#include "raster/probes/probe_capture.h"
#include "raster/probes/solid_test.h"
#include "raster/raster_scene.h"
#include "raster/shader/octahedral_map.h"

#include <array>
#include <cstdint>

namespace duet::raster {

/// Holds the probes of a scene. They do not depend on the view.
class IrradianceProbes {
public:
    /// Renders the probes, and lets light bounce until a bounce adds less than 1 % to it, or 12 times. All further
    /// bounces are added as a geometric series. The result is the same for any number of threads. `seen` is the scene
    /// that the probes see: that of `data`, or one of the same objects with simplified meshes.
    IrradianceProbes(const RasterSceneData& data, const RasterSceneData& seen, const RasterSettings& settings);
    /// Returns the size in meters of the smallest details that probes can show if their number is limited by that of
    /// the primitives; else 0.
    static double detail(const RasterSceneData& data);

    /// Returns the irradiance at points relative to the eye at `eye`, with unit normals; unspecified in lanes that
    /// `mask` leaves out. Nothing lies between the points and p + to_viewer.
    RgbT<Floats> irradiance(const Vec3d& eye, const Vec3T<Floats>& p, const Vec3T<Floats>& n,
                            const Vec3T<Floats>& to_viewer, const xsimd::batch_bool<float>& mask) const;
    /// This overload takes points that a camera sees.
    RgbT<Floats> irradiance(const ScreenProjection& camera, const Vec3T<Floats>& p, const Vec3T<Floats>& n,
                            const xsimd::batch_bool<float>& mask) const {
        return irradiance(camera.eye(), p, n, to_viewer(camera, p), mask);
    }
    /// Returns the mean radiance from all directions at points in space. Walls between two probes do not block it. Far
    /// from the probes it is that of `sky`, weighted by the fraction of the sky that the probes see. `sky` may be
    /// empty.
    RgbT<Floats> mean_radiance(const Vec3d& eye, const Vec3T<Floats>& p, const AmbientLight& sky) const;
    /// Returns the distance between neighboring probes, in meters: the largest of the three axes.
    float spacing() const;
    std::size_t memory_bytes() const;

private:
    struct Probe {
        Vec3d position;
        IrradianceHarmonics irradiance{};
        OctahedralMap distance; ///< mean and mean square of the surfaces' distances; empty inside an object
    };

    void place(const RasterSceneData& data, const RasterSceneData& seen);
    Vec3d grid_point(std::size_t probe) const;
    bool move_out_of_solids(const SolidTest& solids, Vec3d& position) const;
    void set_distances(const ProbeCapture& capture, Probe& probe) const;
    /// Holds the weights of the eight probes around each point of a batch.
    struct Weights {
        Ints cells;                    ///< the first probe of each point's cell
        std::array<Floats, 8> corners; ///< weights by corner of the cell
        Floats sum;
        Floats beyond; ///< distance from the grid, in cells
    };
    IrradianceHarmonics gather(const ProbeCapture& capture, int bounce, std::vector<Weights>& weights) const;
    void drop_strays(std::vector<std::unique_ptr<ProbeCapture>>& captures) const;
    void find_sights(const std::vector<std::unique_ptr<ProbeCapture>>& captures);
    bool sees(const ProbeCapture& capture, std::size_t from, std::size_t to) const;
    std::size_t corner_of(std::size_t cell, unsigned corner) const;
    void bounce_light(const std::vector<std::unique_ptr<ProbeCapture>>& captures, int threads);
    void fill_solids();
    void find_sky(const RasterSceneData& data, const RasterSettings& settings,
                  const std::vector<std::unique_ptr<ProbeCapture>>& captures);
    static Floats sky_share(const Floats& cells);
    RgbT<Floats> faded_to_sky(const RgbT<Floats>& irradiance, const std::array<Floats, 9>& basis,
                              const Floats& cells) const;
    /// Returns the vector from points that a camera sees to its eye.
    static Vec3T<Floats> to_viewer(const ScreenProjection& camera, const Vec3T<Floats>& p) {
        return camera.to_viewer(p) * camera.distance(p);
    }
    struct Place;
    Place place_of(const Vec3d& eye, const Vec3T<Floats>& p) const;
    Weights weights(const Vec3d& eye, const Vec3T<Floats>& p, const Vec3T<Floats>& n, const Vec3T<Floats>& to_viewer,
                    const xsimd::batch_bool<float>& mask) const;
    RgbT<Floats> irradiance(const Weights& weights, const Vec3T<Floats>& n,
                            const xsimd::batch_bool<float>& mask) const;
    template <typename Visit> void for_each_neighbor(std::size_t probe, const Visit& visit) const;

    Vec3d origin_;              ///< position of the first probe
    Vec3d step_;                ///< distance between probes along each axis
    std::array<int, 3> size_{}; ///< number of probes along each axis; at least 2
    std::vector<Probe> probes_; ///< in grid order, x fastest
    /// For each cell, indexed by its first probe, and each of its eight corners, a bit mask says which corners see it.
    /// Bit 0 of a corner's number is set if it is further along x, bit 1 along y, bit 2 along z.
    std::vector<std::array<std::uint8_t, 8>> sights_;
    IrradianceHarmonics sky_{}; ///< irradiance of the environment, for points far beyond the probes
    float openness_ = 0;        ///< weight of sky_ there, in [0, 1]; 0 in a closed room
};

} // namespace duet::raster
