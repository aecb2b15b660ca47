// What of the lights' light arrives: each light's maps, and how to read them.
#pragma once

#include "raster/light/direct.h"
#include "raster/prepare.h"
#include "raster/shadow/light_views.h"
#include "raster/shadow/soft_shadow.h"

#include <memory>
#include <span>
#include <vector>

namespace duet::raster {

/// All shadow maps of a scene. They do not depend on the view.
///
/// A scene that moves has them for several moments of the shutter's interval; a moving receiver is looked up where it
/// stood at the map's moment, so that nothing shades itself by its own motion.
class Shadows {
public:
    /// `data` is all but the shadows of a prepared scene. A sample more than one a pixel asks for several moments.
    Shadows(const PreparedData& data, const Settings& settings);

    /// The part of the light of Scene::lights[light] that arrives at the point, in [0, 1]. The same for any number of
    /// threads. 1 for lights that have no map. `taps`: of each piece of a light with an area.
    float visibility(std::size_t light, const ShadingPoint& point, TapRange taps) const;

    std::size_t unshadowed() const { return unshadowed_; } ///< lights left without, weakest first
    std::size_t moments() const { return moments_.size(); }
    bool coarser() const { return coarser_; } ///< than Settings::shadow_map_side asks for, as so many would not fit in memory
    std::int64_t memory_bytes() const { return memory_bytes_; }

    static constexpr int kMoments = 8;
    static constexpr std::size_t kMostSources = 64;
    static constexpr int kMostCells = 8; ///< along a light's side

private:
    /// A light's maps at one moment; all empty: none. Views are tried in order; a point light has one cube.
    struct Maps {
        std::vector<ShadowMap> views;
        std::vector<CubeMap> cubes;
        std::vector<SoftLight> cells; ///< of surface lights: parallel to Source::cells
    };
    /// What shares maps: one point, spot or sun light; or the surface lights of one object that lie in one plane, or
    /// that are all of a lamp.
    struct Source {
        std::vector<std::size_t> lights;
        std::vector<Emitter> cells;     ///< of surface lights: its pieces, each with maps of its own; else none
        bool lamp = false;              ///< its object, which does nothing but shine, is left out of its maps
        std::vector<Maps> moments;      ///< parallel to moments_
    };
    std::vector<Source> find_sources(const Scene& scene, int cells);
    /// `seen`: what the scene's camera sees, where there is a sun.
    std::vector<Camera> views_of(const PreparedData& data, const std::vector<SeenPoint>& seen, const Source& source) const;
    void fit_sides(const PreparedData& data, const std::vector<SeenPoint>& seen);
    /// `views`: views_of the source.
    void draw(const PreparedData& data, const Settings& settings, std::span<const Camera> views, Source& source, double moment,
              Maps& maps);
    /// `plane`: of an emitter in one plane, which `back` says shines to both sides.
    CubeMap draw_cube(const Prepared& casters, Vec3d center, const Emitter* plane, bool back, double moment, int side,
                      int threads);
    float visibility(const Source& source, const Maps& maps, const Receiver& receiver, TapRange taps) const;

    const Scene& scene_;
    double scene_size_;
    int side_, cube_side_;
    std::vector<Source> sources_;
    std::vector<std::size_t> source_of_; ///< of each light; sources_.size(): none
    std::vector<double> moments_;
    std::size_t unshadowed_ = 0;
    bool coarser_ = false;
    std::int64_t memory_bytes_ = 0;
};

} // namespace duet::raster
