// This header declares the shadow maps of all lights and their lookup.
#pragma once

#include "raster/raster_scene.h"
#include "raster/shadows/cube_map.h"
#include "raster/shadows/emitter.h"
#include "raster/shadows/light_views.h"
#include "raster/shadows/pcf.h"
#include "raster/shadows/pcss.h"

#include <span>
#include <vector>

namespace duet::raster {

/// Holds all shadow maps of a scene. They do not depend on the view. A scene with motion has maps for several moments
/// of the shutter interval.
class Shadows {
public:
    /// `data` is the prepared scene except for its shadows. More than one sample per pixel causes several moments to
    /// be rendered if the scene moves.
    Shadows(const RasterSceneData& data, const RasterSettings& settings);

    /// Returns the number of lights without maps; the weakest lights have none.
    std::size_t unshadowed() const { return unshadowed_; }
    std::size_t moments() const { return moments_.size(); }
    /// Returns whether maps are smaller than RasterSettings::shadow_map_side requests, to limit memory.
    bool coarser() const { return coarser_; }
    std::int64_t memory_bytes() const;

    /// Holds a source's maps at one moment; a source without casters has none. Maps of suns, spots and point lights are
    /// sharp. They overlap, and the first that contains a point is sampled.
    struct Maps {
        std::vector<ShadowMap> sharp;
        std::vector<SoftShadowMap> soft; ///< maps of surface lights, parallel to Source::cells
    };
    /// Represents lights that share maps: one point, spot or sun light, or the coplanar surface lights of one object,
    /// or all surface lights of an object that only emits.
    struct Source {
        std::vector<std::size_t> lights;
        std::vector<Emitter> cells; ///< pieces of a surface light, each with its own maps; else empty
        bool emits_only = false;    ///< whether its object only emits and is excluded from its own maps
        float sine = 0;             ///< of the angular radius of the environment's sun; 0 for other lights
        std::vector<Maps> moments;      ///< parallel to moments_
    };
    const std::vector<Source>& sources() const { return sources_; }
    /// Returns the index of a light's source; sources().size() if it has no maps.
    std::size_t source_of(std::size_t light) const { return source_of_[light]; }
    /// Returns, for each object, the transform from its position at `time` to its position in the maps of that time;
    /// nothing for objects that do not move. The result is empty if there is only one moment.
    std::vector<std::optional<Mat4d>> motions(float time) const;
    /// Returns the index of the moment whose maps are used at a time.
    std::size_t moment_at(float time) const;

    static constexpr int kMoments = 8; ///< evenly spaced in the shutter interval
    static constexpr std::size_t kMaxSources = 64; ///< UnblockedTiles has one bit per source
    static constexpr int kMaxCells = 8; ///< cells along each side of a light, at most

private:
    std::vector<Source> find_sources(const RasterSceneData& data, int cells);
    /// `visible` holds the points visible to the scene's camera if there is a sun.
    std::vector<Camera> views_of(const RasterSceneData& data, const std::vector<VisiblePoint>& visible,
                                 const Source& source) const;
    void fit_sides(const RasterSceneData& data, const std::vector<VisiblePoint>& visible);
    /// `views` is the result of views_of for the source.
    Maps draw(const RasterSceneData& data, const RasterSettings& settings, std::span<const Camera> views,
              const Source& source, double moment) const;
    CellMaps draw_cell(const RasterSceneData& data, const Source& source, const Emitter& cell, double moment,
                       int threads) const;
    /// Renders a cube map. The object `excluded` casts no shadow, nor does any surface at a depth below `near`. `plane`
    /// is a planar emitter, or null; `back` says whether it also emits on its back side.
    CubeMap draw_cube(const RasterSceneData& data, std::uint32_t excluded, Vec3d center, const Emitter* plane,
                      bool back, double moment, int side, double near, int threads) const;

    const Scene& scene_;
    double scene_size_;
    int side_, cube_side_;
    std::vector<Source> sources_;
    std::vector<std::size_t> source_of_; ///< for each light; sources_.size() if it has no maps
    std::vector<double> moments_;
    std::size_t unshadowed_ = 0;
    bool coarser_ = false;
};

/// Holds the maps of all sources at one time, for lookups of points relative to one eye.
class MapsAtTime {
public:
    /// Keeps a reference to `shadows`.
    MapsAtTime(const Shadows& shadows, const Vec3d& eye, float time);

    /// Returns the maps of the cells of a source; none if its maps are sharp.
    std::span<const SoftShadowMap> soft(std::size_t source) const {
        return shadows_.sources()[source].moments[moment_].soft;
    }
    /// Returns the visible fraction of a source: the mean of in_soft(map) over its cells, or in_sharp(map, inside) of
    /// the first map that contains a point, which sets the lanes `inside`. Points outside of all maps are lit.
    template <typename InSharp, typename InSoft>
    Floats visibility(std::size_t source, const InSharp& in_sharp, const InSoft& in_soft) const {
        if (const std::span<const SoftShadowMap> maps = soft(source); !maps.empty()) {
            Floats sum(0.0f);
            for (const SoftShadowMap& map : maps) sum += in_soft(map);
            return sum * Floats(1 / static_cast<float>(maps.size()));
        }
        Floats result(1.0f);
        xsimd::batch_bool<float> found(false);
        for (const SharpShadowMap& map : sharp_[source]) {
            xsimd::batch_bool<float> inside;
            const Floats seen = in_sharp(map, inside);
            result = xsimd::select((!found) & inside, seen, result);
            found = found | inside;
            if (xsimd::all(found)) break;
        }
        return result;
    }

private:
    const Shadows& shadows_;
    std::size_t moment_;
    std::vector<std::vector<SharpShadowMap>> sharp_; ///< for each source
};

} // namespace duet::raster
