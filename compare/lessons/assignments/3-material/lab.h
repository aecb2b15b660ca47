// Assignment 3: rough metal, from its paper.
//
// Directions are unit vectors in the local frame of the surface, whose normal is +z. wo points to the viewer, wi to the
// light; both point away from the surface. The roughness alpha is in [0.05, 1].
#pragma once

#include "common/image/rgb.h"
#include "common/vec/vec.h"
#include "tests/grading/lab.h"

#include <vector>

namespace duet::lab {

/// D: how densely microfacet normals point in the direction m, per steradian (Walter et al. 2007, eq. 33, where alpha
/// is called alpha_g). 0 where m points below the surface.
float ggx_distribution(Vec3 m, float alpha);

/// Λ (Lambda): how much microfacet area is hidden from w for each unit that is visible, at least 0 (Heitz 2014, eq.
/// 72). Smith's masking is G1 = 1 / (1 + Λ). w.z > 0.
float smith_lambda(Vec3 w, float alpha);

/// The BRDF of rough metal for each direction of wi, without the cosine: F·D·G2 / (4·cos θo·cos θi) with
/// G2 = 1 / (1 + Λ(wo) + Λ(wi)) (Heitz 2014, eq. 99) and Schlick's F = f0 + (1 - f0)·(1 - wo·m)⁵, where m is the unit
/// vector halfway between wo and wi. Black where wo or wi lies below the surface. One value for each wi.
std::vector<Rgb> metal_eval(Vec3 wo, const std::vector<Vec3>& wi, float alpha, Rgb f0);

/// A direction wi for each pair of random numbers in [0, 1)², drawn about where metal_eval is large, for wo.z > 0. Any
/// way to draw them is fine (Walter et al. 2007, §5.2, is the simplest) if metal_pdf is its density. Return (0, 0, 0)
/// where what you drew lies below the surface.
std::vector<Vec3> metal_sample(Vec3 wo, float alpha, const std::vector<Vec2>& random);

/// The density of metal_sample by solid angle of wi, for each wi; 0 below the surface.
std::vector<float> metal_pdf(Vec3 wo, const std::vector<Vec3>& wi, float alpha);

} // namespace duet::lab

DUET_LAB(ggx_distribution, smith_lambda, metal_eval, metal_sample, metal_pdf)
