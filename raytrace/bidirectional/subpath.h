// Declares subpaths, which start at the camera or at a light. Bidirectional path tracing joins the vertices of two
// subpaths.
#pragma once

#include "raytrace/integrator/path.h"

namespace duet::raytrace {

/// Stores partial sums of MIS weights. A path of several segments can be drawn by many strategies: any of its edges may
/// be the connection of a light subpath with a camera subpath. The weight of the strategy that drew the path is 1 / (1
/// + sum of the other strategies' densities over its own). MisSums are the terms of that sum that a subpath knows
/// before it is connected. They are updated from vertex to vertex (Georgiev 2012, "Implementing Vertex Connection and
/// Merging", §4).
///
/// If subpaths may also merge, at vertices closer than a radius, each vertex adds one more strategy. `merging` is η,
/// the number of light subpaths times the area of the disk of that radius, which is the density of merging over that of
/// connecting. It is 0 if subpaths do not merge. They do not merge at the first hit of a light subpath, because light
/// samples find direct light better.
struct MisSums {
    /// `connection` represents the strategy that connects this vertex with the one before, instead of a sampled ray. It
    /// is the ratio of densities d_VCM, without the factor `pdf` of over_connection().
    double connection = 0;
    /// `earlier` represents all strategies that connect an earlier pair of vertices, or merge a vertex before the last:
    /// d_VC, without `pdf` and `reverse_pdf`.
    double earlier = 0;
    /// `last_merging` represents the strategy that merges the last vertex. It is 0 at the first hit of a light subpath.
    double last_merging = 0;
    /// `earlier_than_merging` represents all strategies that connect or merge earlier vertices, relative to merging at
    /// this one: d_VM. It is not used if subpaths do not merge.
    double earlier_than_merging = 0;

    /// Updates the sums when the subpath hits a surface, at |cos θ| = `cosine` to its geometric normal.
    void arrive(double squared_distance, double cosine);
    /// Updates the sums when the subpath is scattered. `pdf` is the density of the new direction, at |cos θ| = `cosine`
    /// to the geometric normal, and `reverse_pdf` the density of scattering in the opposite direction. No connection
    /// ends at a specular vertex. `merges` says whether this vertex may merge.
    void scatter(double pdf, double reverse_pdf, double cosine, bool specular, double merging, bool merges);
    /// Returns the sum over all strategies whose connection is on this side of the current one. `pdf` is the density by
    /// area with which the other subpath would draw this vertex, and `reverse_pdf` the density by solid angle with
    /// which it would continue from here to the vertex before. `merging` is 0 if this vertex is the first that the
    /// light reaches.
    double over_connection(double pdf, double reverse_pdf, double merging) const {
        return mis(pdf) * (mis(merging) + connection + (earlier + last_merging) * mis(reverse_pdf));
    }
    /// Returns the sum for the case that this vertex merges with one of the other subpath. `reverse_pdf` is the same as
    /// for over_connection().
    double over_merging(double reverse_pdf, double merging) const {
        return connection / mis(merging) + earlier_than_merging * mis(reverse_pdf);
    }
};

/// Represents a vertex of a subpath, with the throughput and the MIS sums up to it.
struct SubpathVertex {
    /// Constructs the vertex at a valid hit of a ray of the subpath, after `depth_` scatterings; see Vertex.
    SubpathVertex(const RenderPlan& plan, const Ray& ray, const Hit& hit, const RayFootprint* footprint, int depth_)
        : vertex(plan, ray, hit, footprint), to_previous(-ray.direction), depth(depth_) {}

    const Vertex vertex;
    const Vec3 to_previous; ///< unit direction to the vertex before, in world space
    const int depth;        ///< number of scatterings before this vertex
    Rgb throughput;
    MisSums mis;

    /// Returns |cos θ| of a direction to the geometric normal.
    double cosine(Vec3 w) const { return static_cast<double>(abs(dot(vertex.point.ng, w))); }
    /// Returns |cos θ| of the direction from which a light subpath would arrive at this vertex of a camera subpath. The
    /// shading normal lets the vertex reflect light from below the triangle's plane (see shading_terminator.h). For
    /// such light the result is 0, because a light subpath hits the triangle from its other side.
    double cosine_of_light(Vec3 wi) const;
    /// Returns the density by solid angle with which a subpath of the given mode that came from `from` leaves in
    /// direction `to` (both unit, in world space, away from the vertex).
    double pdf(Vec3 from, Vec3 to, TransportMode mode) const;
    /// Returns f·|cos θ| with which a vertex of a light subpath scatters light from the previous vertex in direction w.
    Rgb importance_scattering(Vec3 w) const;
    /// Returns the origin of a ray from this vertex of a light subpath toward w. It lies on the triangle, where the
    /// rays of camera subpaths end, and not on the smooth surface from which they start.
    Vec3 importance_origin(Vec3 w) const;
};

/// Draws the direction in which a subpath of the given mode leaves the vertex, and updates the path's throughput and
/// sums.
ScatteringT<float> scatter(const SubpathVertex& at, const VertexRandomSamples& u, TransportMode mode,
                           PathThroughputT<float>& path, MisSums& sums, double merging);

} // namespace duet::raytrace
