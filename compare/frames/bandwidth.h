// This file measures how fast this computer copies memory, the limit of stages that stream whole images.
#pragma once

namespace duet::compare {

/// Returns the bytes per second at which so many threads copy an array that exceeds the caches: the bytes read and the
/// bytes written together, by the fastest of several copies, as STREAM counts them (McCalpin 1995, "Memory Bandwidth
/// and Machine Balance in Current High Performance Computers").
double copy_bandwidth(int threads);

} // namespace duet::compare
