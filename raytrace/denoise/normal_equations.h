// Declares NormalEquations, which solves small weighted least-squares problems, one per SIMD lane.
#pragma once

#include "raytrace/denoise/features.h"

#include <array>

namespace duet::raytrace {

/// A first-order model of the color around a pixel has a slope per feature, and a constant, which comes last.
inline constexpr std::size_t kTerms = kFeatures + 1;

/// Accumulates the normal equations of a batch of pixels and solves them for the three color channels.
class NormalEquations {
public:
    using Terms = std::array<PixelBatch, kTerms>;
    using Color = std::array<PixelBatch, 3>;

    NormalEquations() {
        for (Terms& row : matrix_) row.fill(PixelBatch(0.0f));
        for (Terms& side : right_) side.fill(PixelBatch(0.0f));
    }

    /// Adds a pixel with the given weight. The last of the terms must be 1.
    void add(PixelBatch weight, const Terms& terms, const Color& color) {
        for (std::size_t i = 0; i < kTerms; ++i) {
            const PixelBatch weighted = weight * terms[i];
            for (std::size_t j = 0; j <= i; ++j) matrix_[i][j] = multiply_add(weighted, terms[j], matrix_[i][j]);
            for (std::size_t c = 0; c < 3; ++c) right_[c][i] = multiply_add(weighted, color[c], right_[c][i]);
        }
    }

    /// Returns the coefficients of each channel, by a Cholesky decomposition. A ridge keeps slopes small along features
    /// that do not vary in the window. It is relative to the sum of the weights, so that it acts where a feature's
    /// standard deviation is less than about 0.005; albedos and normals have a range of 1.
    std::array<Terms, 3> solve() {
        constexpr float kRidge = 3e-5f;
        const PixelBatch ridge = matrix_[kTerms - 1][kTerms - 1] * PixelBatch(kRidge);
        for (std::size_t i = 0; i < kFeatures; ++i) matrix_[i][i] += ridge;
        decompose();
        for (Terms& side : right_) {
            for (std::size_t i = 0; i < kTerms; ++i) {
                for (std::size_t k = 0; k < i; ++k) side[i] = negated_multiply_add(matrix_[i][k], side[k], side[i]);
                side[i] *= matrix_[i][i];
            }
            for (std::size_t i = kTerms; i-- > 0;) {
                for (std::size_t k = i + 1; k < kTerms; ++k)
                    side[i] = negated_multiply_add(matrix_[k][i], side[k], side[i]);
                side[i] *= matrix_[i][i];
            }
        }
        return right_;
    }

private:
    // Replaces the matrix by its Cholesky factor. The diagonal holds the inverses of the factor's diagonal.
    void decompose() {
        const PixelBatch least(1e-20f); // for lanes of weight 0, and for cancellation on the diagonal
        for (std::size_t i = 0; i < kTerms; ++i) {
            for (std::size_t j = 0; j < i; ++j) {
                for (std::size_t k = 0; k < j; ++k)
                    matrix_[i][j] = negated_multiply_add(matrix_[i][k], matrix_[j][k], matrix_[i][j]);
                matrix_[i][j] *= matrix_[j][j];
            }
            for (std::size_t k = 0; k < i; ++k)
                matrix_[i][i] = negated_multiply_add(matrix_[i][k], matrix_[i][k], matrix_[i][i]);
            matrix_[i][i] = PixelBatch(1.0f) / xsimd::sqrt(xsimd::max(matrix_[i][i], least));
        }
    }

    std::array<Terms, kTerms> matrix_; // the lower triangle, row by row
    std::array<Terms, 3> right_;       // right-hand sides by color channel
};

} // namespace duet::raytrace
