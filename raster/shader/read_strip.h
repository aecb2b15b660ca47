// Reads the ids of a packet and finds the triangle setup of each sample.
#pragma once

#include "raster/shader/set_ups.h"
#include "raster/visibility/strip_samples.h"

#include <bit>

namespace duet::raster {

/// Holds a packet whose samples see triangles of one object, and the cache slots of their triangle setups.
template <VertexShader S, typename D> struct ReadStrip : StripSamples {
    using Sixteen = SetUp<S, D>;

    StripOf<std::int32_t> kept;  ///< cache slot per sample, see SetUps::keep
    StripOf<std::int32_t> lanes; ///< index of each sample's setup among the 32 of its pair
    /// Stores two groups of sixteen setups, with one bit per sample whose setup is among them.
    struct Pair {
        const Sixteen *first, *second;
        std::uint32_t samples;
    };
    std::array<Pair, kStrip / 2> pairs;
    std::size_t pair_count = 0;
    bool one = false; ///< all samples see the same triangle

    /// Groups the setups into pairs. It must be called after SetUps::finish().
    void find_pairs(const SetUps<S, D>& set_ups);
    /// Returns true if SetUp::easy holds for all visible triangles.
    bool all_easy() const;
    /// Calls use(own), where own.get() looks up a value of each sample's setup (see below).
    template <typename Use> void with_own(const Use& use) const {
        const Pair& pair = pairs[0];
        if (Floats::size < kStrip && one) // where a lookup takes more than one step
            use(OfOne{*pair.first, static_cast<std::size_t>(lanes[0])});
        else if (pair_count == 1 && pair.first == pair.second)
            use(OfSixteen{*pair.first, lanes});
        else if (pair_count == 1)
            use(OfPair{*pair.first, *pair.second, lanes});
        else
            use(OfPairs{*this});
    }

private:
    /// get(i, of) returns for one batch of samples from the i-th on a value of each sample's setup. of() selects
    /// the array in a group of sixteen setups. OfOne: all samples see one triangle. OfSixteen, OfPair: all setups
    /// are in one or two groups of sixteen. OfPairs: the general case.
    struct OfOne {
        const Sixteen& sixteen;
        std::size_t lane;
        template <typename T, typename Of> xsimd::batch<T> get(std::size_t, const Of& of) const {
            return xsimd::batch<T>(of(sixteen)[lane]);
        }
    };
    struct OfSixteen {
        const Sixteen& sixteen;
        const StripOf<std::int32_t>& lanes;
        template <typename T, typename Of> xsimd::batch<T> get(std::size_t i, const Of& of) const {
            return look_up(of(sixteen), lanes, i);
        }
    };
    struct OfPair {
        const Sixteen &first, &second;
        const StripOf<std::int32_t>& lanes;
        template <typename T, typename Of> xsimd::batch<T> get(std::size_t i, const Of& of) const {
            return look_up(of(first), of(second), lanes, i);
        }
    };
    struct OfPairs {
        const ReadStrip& strip;
        template <typename T, typename Of> xsimd::batch<T> get(std::size_t i, const Of& of) const {
            const auto of_pair = [&](const auto& pair) {
                return look_up(of(*pair.first), of(*pair.second), strip.lanes, i);
            };
            xsimd::batch<T> value = of_pair(strip.pairs[0]);
            for (std::size_t k = 1; k < strip.pair_count; ++k)
                value = xsimd::select(lanes_from<T>(strip.pairs[k].samples >> i), of_pair(strip.pairs[k]), value);
            return value;
        }
    };
};

template <VertexShader S, typename D> void ReadStrip<S, D>::find_pairs(const SetUps<S, D>& set_ups) {
    constexpr std::int32_t kEach = kStrip;
    StripOf<std::int32_t> sixteens;
    for (std::size_t i = 0; i < kStrip; i += Ints::size) {
        const Ints here = load(kept, i);
        store(sixteens, i, here >> std::countr_zero(kStrip));
        store(lanes, i, here & Ints(kEach - 1));
    }
    one = Floats::size < kStrip && lanes_of_number(kept, kept[0]) == (1u << kStrip) - 1;
    pair_count = 0;
    std::uint32_t left = (1u << kStrip) - 1, seconds = 0;
    const auto take = [&](std::uint32_t& taken) {
        const std::int32_t number = sixteens[static_cast<std::size_t>(std::countr_zero(left))];
        taken = lanes_of_number(sixteens, number);
        left &= ~taken;
        return &set_ups.sixteen(static_cast<std::size_t>(number));
    };
    while (left != 0) {
        std::uint32_t firsts = 0, here = 0;
        const Sixteen* first = take(firsts);
        const Sixteen* second = left != 0 ? take(here) : first;
        seconds |= here;
        pairs[pair_count++] = {first, second, firsts | here};
    }
    if (seconds == 0) return;
    for (std::size_t i = 0; i < kStrip; i += Ints::size) {
        const auto in_second = xsimd::bool_cast(lanes_from<float>(seconds >> i));
        store(lanes, i, load(lanes, i) + xsimd::select(in_second, Ints(kEach), Ints(0)));
    }
}

template <VertexShader S, typename D> bool ReadStrip<S, D>::all_easy() const {
    std::uint32_t easy = 0;
    for (std::size_t k = 0; k < pair_count; ++k) {
        const auto& pair = pairs[k];
        const std::uint32_t of_pair = pair.first->easy | pair.second->easy << kStrip;
        if (of_pair == ~std::uint32_t{0}) { // the common case
            easy |= pair.samples;
            continue;
        }
        for (std::size_t i = 0; i < kStrip; i += Ints::size) {
            const Ints bit = Ints(1) << load(lanes, i);
            easy |= pair.samples & lane_bits((Ints(static_cast<std::int32_t>(of_pair)) & bit) != Ints(0)) << i;
        }
    }
    return easy == (1u << kStrip) - 1;
}

} // namespace duet::raster
