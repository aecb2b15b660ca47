#include "common/system/error.h"
#include "common/system/file.h"
#include "common/system/parallel.h"
#include "common/system/stopwatch.h"

#include <doctest/doctest.h>

#include <atomic>
#include <thread>
#include <vector>

using namespace duet;

TEST_SUITE("unit") {

    TEST_CASE("a parallel loop runs each index once, on more threads than cores too") {
        for (const int threads : {0, 1, 2, 7}) {
            std::vector<std::atomic<int>> calls(1000);
            parallel_for(calls.size(), threads, [&](std::size_t i) { ++calls[i]; });
            for (const auto& c : calls) REQUIRE(c == 1);
        }
        parallel_for(0, 0, [](std::size_t) { FAIL("no index to call"); });
    }

    TEST_CASE("loops of two threads do not wait for each other") {
        std::atomic<bool> ended = false, waited_in_vain = false;
        std::atomic<int> entered = 0;
        const Stopwatch watch;
        const auto wait = [&](std::size_t) {
            ++entered;
            while (!ended && watch.seconds() < 20) std::this_thread::yield();
            if (!ended) waited_in_vain = true;
        };
        std::thread other([&] { parallel_for(2, 2, wait); });
        while (entered < 2 && watch.seconds() < 10) std::this_thread::yield(); // until both threads of it are busy
        parallel_for(4, 2, [](std::size_t) {});
        ended = true;
        other.join();
        CHECK_FALSE(waited_in_vain);
    }

    TEST_CASE("a loop in a parallel loop runs each index once") {
        std::vector<std::atomic<int>> calls(400);
        parallel_for(20, 2, [&](std::size_t i) {
            parallel_for(20, 2, [&](std::size_t k) { ++calls[20 * i + k]; });
        });
        for (const auto& c : calls) REQUIRE(c == 1);
    }

    TEST_CASE("an exception in a parallel loop reaches the caller") {
        for (const int threads : {1, 2, 7})
            CHECK_THROWS_AS(parallel_for(100, threads,
                                         [](std::size_t i) {
                                             if (i == 57) throw Error("57");
                                         }),
                            Error);
    }

    TEST_CASE("an output file is whole or absent") {
        const std::filesystem::path folder = std::filesystem::path(DUET_BINARY_DIR) / "tests/scratch/system";
        std::filesystem::remove_all(folder);
        std::filesystem::create_directories(folder);
        write_file(folder / "a.txt", "whole");
        CHECK(read_file(folder / "a.txt") == "whole");
        CHECK_THROWS_AS(write_atomically(folder / "b.txt",
                                         [](const auto& temporary) {
                                             write_file(temporary, "half");
                                             throw Error("disk full", 1);
                                         }),
                        Error);
        CHECK_FALSE(std::filesystem::exists(folder / "b.txt"));
        CHECK(std::distance(std::filesystem::directory_iterator(folder), {}) == 1); // no temporary file remains
        CHECK_THROWS_AS(write_file(folder / "no/such/folder.txt", "x"), Error);
        CHECK_THROWS_AS(read_file(folder / "missing"), Error);
        CHECK_THROWS_AS(read_file(folder), Error);
        CHECK_THROWS_AS(read_file(folder / "a.txt", 3), Error);
    }

} // TEST_SUITE
