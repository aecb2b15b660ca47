// The process that runs a student's code. It is compiled together with it, with DUET_LAB_HEADER naming the lab's
// contract, and holds no expected answer: it reads calls, makes them, and writes back what the functions return.
#define DUET_LAB_WORKER
#include DUET_LAB_HEADER

#include "common/system/error.cpp" // a failed check of a header's; here the worker stays one file, and compiles faster
#include "tests/grading/channel.h"

#include <cstdio>
#include <exception>

namespace {

bool g_not_attempted = false;

std::string reply_to(std::string_view request) {
    using namespace duet::grading;
    Reader in(request);
    Writer reply, result;
    g_not_attempted = false;
    const auto finish = [&](Outcome outcome, const std::string& text) {
        reply.put(outcome);
        reply.put(g_not_attempted);
        reply.put(text);
        return reply.bytes();
    };
    try {
        const auto name = in.get<std::string>();
        if (!call_by_name(name, in, result)) return finish(Outcome::kThrew, "the worker knows no function " + name);
        return finish(Outcome::kReturned, result.bytes());
    } catch (const std::bad_alloc&) {
        return finish(Outcome::kOutOfMemory, "");
    } catch (const std::exception& error) {
        return finish(Outcome::kThrew, error.what());
    } catch (...) {
        return finish(Outcome::kThrew, "something that is no std::exception");
    }
}

} // namespace

void duet::lab::not_attempted() { g_not_attempted = true; }

int main() {
    using namespace duet::grading;
    for (std::string request; receive(kRequestDescriptor, request);) {
        const std::string reply = reply_to(request);
        std::fflush(nullptr); // what the student printed: the grader ends this process without asking
        if (!send(kReplyDescriptor, reply)) break;
    }
}
