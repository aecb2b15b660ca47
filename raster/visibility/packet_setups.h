// Reads the ids of a packet and finds the triangle setup of each sample.
#pragma once

#include "raster/visibility/packet_primitives.h"
#include "raster/visibility/setup_cache.h"

#include <bit>

namespace duet::raster {

/// Holds a packet whose samples see triangles of one object, and the cache slots of their triangle setups.
template <VertexShader S, typename D> struct PacketSetups : PacketPrimitives {
    using Setups = SetupPacket<S, D>;

    PacketOf<std::int32_t> slots; ///< cache slot per sample, see SetupCache::lookup_or_insert
    PacketOf<std::int32_t> lanes; ///< index of each sample's setup among the 32 of its pair
    /// Stores two groups of packet setups, with one bit per sample whose setup is among them.
    struct Pair {
        const Setups *first, *second;
        std::uint32_t samples;
    };
    std::array<Pair, kPacketSize / 2> pairs;
    std::size_t pair_count = 0;
    bool one = false; ///< whether all samples see the same triangle

    /// Groups the setups into pairs. It must be called after SetupCache::finish().
    void find_pairs(const SetupCache<S, D>& setups);
    /// Calls use(lookup), where lookup.get() reads a value of each sample's setup (see FromOneTriangle).
    template <typename Use> void with_lookup(const Use& use) const {
        const Pair& pair = pairs[0];
        if (Floats::size < kPacketSize && one) // a lookup takes several steps here
            use(FromOneTriangle{*pair.first, static_cast<std::size_t>(lanes[0])});
        else if (pair_count == 1 && pair.first == pair.second)
            use(FromOnePacket{*pair.first, lanes});
        else if (pair_count == 1)
            use(FromPair{*pair.first, *pair.second, lanes});
        else
            use(FromPairs{*this});
    }

private:
    /// These classes have a function get(i, of), which returns a value of each sample's setup for one batch of samples
    /// from the i-th on. of() selects the array in a group of setups. With FromOneTriangle, all samples see one
    /// triangle. With FromOnePacket and FromPair, all setups are in one or two groups. FromPairs is the general case.
    struct FromOneTriangle {
        const Setups& packet;
        std::size_t lane;
        template <typename T, typename Of> xsimd::batch<T> get(std::size_t, const Of& of) const {
            return xsimd::batch<T>(of(packet)[lane]);
        }
    };
    struct FromOnePacket {
        const Setups& packet;
        const PacketOf<std::int32_t>& lanes;
        template <typename T, typename Of> xsimd::batch<T> get(std::size_t i, const Of& of) const {
            return look_up(of(packet), lanes, i);
        }
    };
    struct FromPair {
        const Setups &first, &second;
        const PacketOf<std::int32_t>& lanes;
        template <typename T, typename Of> xsimd::batch<T> get(std::size_t i, const Of& of) const {
            return look_up(of(first), of(second), lanes, i);
        }
    };
    struct FromPairs {
        const PacketSetups& setups;
        template <typename T, typename Of> xsimd::batch<T> get(std::size_t i, const Of& of) const {
            const auto of_pair = [&](const auto& pair) {
                return look_up(of(*pair.first), of(*pair.second), setups.lanes, i);
            };
            xsimd::batch<T> value = of_pair(setups.pairs[0]);
            for (std::size_t k = 1; k < setups.pair_count; ++k)
                value = xsimd::select(lanes_from<T>(setups.pairs[k].samples >> i), of_pair(setups.pairs[k]), value);
            return value;
        }
    };
};

template <VertexShader S, typename D> void PacketSetups<S, D>::find_pairs(const SetupCache<S, D>& setups) {
    constexpr std::int32_t kEach = kPacketSize;
    PacketOf<std::int32_t> packet_indices;
    for (std::size_t i = 0; i < kPacketSize; i += Ints::size) {
        const Ints here = load(slots, i);
        store(packet_indices, i, here >> std::countr_zero(kPacketSize));
        store(lanes, i, here & Ints(kEach - 1));
    }
    one = Floats::size < kPacketSize && lanes_equal(slots, slots[0]) == (1u << kPacketSize) - 1;
    pair_count = 0;
    std::uint32_t left = (1u << kPacketSize) - 1, seconds = 0;
    const auto take = [&](std::uint32_t& taken) {
        const std::int32_t number = packet_indices[static_cast<std::size_t>(std::countr_zero(left))];
        taken = lanes_equal(packet_indices, number);
        left &= ~taken;
        return &setups.packet(static_cast<std::size_t>(number));
    };
    while (left != 0) {
        std::uint32_t firsts = 0, here = 0;
        const Setups* first = take(firsts);
        const Setups* second = left != 0 ? take(here) : first;
        seconds |= here;
        pairs[pair_count++] = {first, second, firsts | here};
    }
    if (seconds == 0) return;
    for (std::size_t i = 0; i < kPacketSize; i += Ints::size) {
        const auto in_second = xsimd::bool_cast(lanes_from<float>(seconds >> i));
        store(lanes, i, load(lanes, i) + xsimd::select(in_second, Ints(kEach), Ints(0)));
    }
}

} // namespace duet::raster
