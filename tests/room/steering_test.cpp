#include "room/steering.hpp"

#include <doctest/doctest.h>

using namespace vrut;
using namespace vrut::server::room;
using namespace std::chrono_literals;

namespace {

/// Steers where that is allowed.
bool steer(Steering& steering, const char* client, SessionTime now, bool holder_presses) {
    const bool may = steering.may_steer(client, now, holder_presses);
    if (may) steering.steer(client, now);
    return may;
}

}  // namespace

TEST_CASE("who steers first holds control until he has been quiet for a second") {
    Steering steering;
    const SessionTime start = 1h;
    CHECK(steer(steering, "a", start, false));
    CHECK(steering.holder() == "a");
    CHECK_FALSE(steer(steering, "b", start + 999ms, false));
    CHECK(steering.holder() == "a");
    CHECK(steer(steering, "a", start + 999ms, false));
    CHECK_FALSE(steer(steering, "b", start + 1998ms, false));
    CHECK(steer(steering, "b", start + 1999ms, false));
    CHECK(steering.holder() == "b");
}

TEST_CASE("a pressed pointer is not quiet") {
    Steering steering;
    const SessionTime start = 1h;
    CHECK(steer(steering, "a", start, true));
    CHECK_FALSE(steer(steering, "b", start + 1h, true));
    CHECK(steer(steering, "b", start + 1h, false));
}

TEST_CASE("who takes control keeps it, however quiet he is, until he gives it back or another takes it") {
    Steering steering;
    const SessionTime start = 1h;
    CHECK(steer(steering, "a", start, true));
    steering.take("b", start);
    CHECK(steering.holder() == "b");
    CHECK(steering.kept());
    CHECK_FALSE(steer(steering, "a", start + 1h, false));
    steering.take("a", start);
    CHECK(steering.holder() == "a");
    CHECK(steering.release("a"));
    CHECK_FALSE(steering.kept());
    CHECK(steer(steering, "b", start, false));
}

TEST_CASE("a holder who leaves leaves control free, and nobody inherits") {
    Steering steering;
    const SessionTime start = 1h;
    CHECK(steer(steering, "a", start, false));
    CHECK_FALSE(steering.release("b"));
    CHECK(steering.release("a"));
    CHECK_FALSE(steering.holder().has_value());
    CHECK(steer(steering, "b", start, false));
}
