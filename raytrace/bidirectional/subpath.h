// A subpath starts at the camera or at a light. Bidirectional path tracing joins the vertices of two subpaths.
#pragma once

#include "raytrace/integrator/path.h"

namespace duet::raytrace {

/// Returns what a ratio of densities counts in MIS weights: its square (the power heuristic with β = 2).
inline double mis(double ratio) { return ratio * ratio; }

/// A path of several segments can be drawn by many strategies: any of its edges may be the connection of a light
/// subpath with a camera subpath. The weight of the strategy that drew the path is 1 / (1 + sum of the other
/// strategies' densities over its own). These are the parts of that sum that a subpath knows before it is connected.
/// They are updated from vertex to vertex (Georgiev 2012, "Implementing Vertex Connection and Merging", §4).
///
/// Where subpaths may also merge, at vertices closer than a radius, that is one more strategy per vertex.
/// `merging` is η, the number of light subpaths times the area of the disk of that radius: the density of merging over
/// that of connecting. It is 0 where subpaths do not merge. They do not merge at the first hit of a light subpath,
/// because light samples find direct light better.
struct MisSums {
    /// This is the strategy that connects this vertex with the one before, in place of a sampled ray: the ratio of
    /// densities d_VCM, without the factor `pdf` of over_connection().
    double connection = 0;
    /// These are all strategies that connect an earlier pair of vertices, or merge earlier vertices than the last:
    /// d_VC, without `pdf` and `reverse_pdf`.
    double earlier = 0;
    /// This is the strategy that merges the last vertex. It counts only where that is not the first hit of a light
    /// subpath.
    double last_merging = 0;
    /// These are all strategies that connect or merge earlier vertices, over merging at this one: d_VM. Not used where
    /// subpaths do not merge.
    double earlier_than_merging = 0;

    /// Updates the sums where the subpath hits a surface, at |cos θ| = `cosine` to its geometric normal.
    void arrive(double squared_distance, double cosine);
    /// Updates the sums for scattering: `pdf` is the density of the new direction, at |cos θ| = `cosine` to the
    /// geometric normal, and `reverse_pdf` that of scattering backwards along the path. No connection ends at a
    /// specular vertex. `merges` tells whether this vertex may merge.
    void scatter(double pdf, double reverse_pdf, double cosine, bool specular, double merging, bool merges);
    /// Returns the sum over all strategies whose connection is on this side of the current one. `pdf` is the density by
    /// area with which the other side would draw this vertex, and `reverse_pdf` the density by solid angle with which
    /// a subpath of the other side would go on from here to the vertex before. `merging` is 0 where this vertex, on the
    /// way of the light, is the first.
    double over_connection(double pdf, double reverse_pdf, double merging) const {
        return mis(pdf) * (mis(merging) + connection + (earlier + last_merging) * mis(reverse_pdf));
    }
    /// Returns the same sum where this vertex merges with one of the other side. `reverse_pdf` is as above.
    double over_merging(double reverse_pdf, double merging) const {
        return connection / mis(merging) + earlier_than_merging * mis(reverse_pdf);
    }
};

/// Is a vertex of a subpath, with what the subpath carries up to it.
struct SubpathVertex {
    /// Makes the vertex at a valid hit of a ray of the subpath, after `depth_` scatterings; see Vertex.
    SubpathVertex(const RenderPlan& plan, const Ray& ray, const Hit& hit, const RayFootprint* footprint, int depth_)
        : vertex(plan, ray, hit, footprint), to_previous(-ray.direction), depth(depth_) {}

    const Vertex vertex;
    const Vec3 to_previous; ///< unit direction to the vertex before, in world space
    const int depth;        ///< number of scatterings before this vertex
    Rgb throughput;
    MisSums mis;

    /// Returns |cos θ| of a direction to the geometric normal.
    double cosine(Vec3 w) const { return static_cast<double>(abs(dot(vertex.point.ng, w))); }
    /// Returns |cos θ| of the direction from which a light subpath would arrive at this vertex of a camera subpath. It
    /// is 0 for light that the vertex reflects from below the triangle's plane, as the shading normal allows (see
    /// shading_terminator.h): light subpaths hit the triangle from its other side there.
    double cosine_of_light(Vec3 wi) const;
    /// Returns the density by solid angle with which a subpath of the given mode that came from `from` leaves in
    /// direction `to` (both unit, in world space, away from the vertex).
    double pdf(Vec3 from, Vec3 to, TransportMode mode) const;
    /// Returns f·|cos θ| of a vertex of a light subpath in direction w: it scatters light from the vertex before.
    Rgb importance_scattering(Vec3 w) const;
    /// Returns the origin of a ray from this vertex of a light subpath toward w. The light goes where a camera subpath
    /// would come from, whose rays end on the triangle, and not on the smooth surface from which they leave.
    Vec3 importance_origin(Vec3 w) const;
};

/// Draws the direction in which a subpath of the given mode leaves the vertex, and updates the path's throughput and
/// sums.
ScatteringT<float> scatter(const SubpathVertex& at, const VertexRandomSamples& u, TransportMode mode,
                           PathThroughputT<float>& path, MisSums& sums, double merging);

} // namespace duet::raytrace
