#include "room/steering.hpp"

#include <doctest/doctest.h>

using namespace vrut;
using namespace vrut::server::room;
using namespace std::chrono_literals;

namespace {

using ClientIds = std::vector<std::string>;

Steering steering_of(const ClientIds& clients) {
    Steering steering;
    for (const std::string& client : clients) steering.join(client, "key of " + client);
    return steering;
}

}  // namespace

TEST_CASE("the first control client holds control, and others do not get it by coming") {
    const Steering steering = steering_of({"a", "b"});
    CHECK(steering.holder() == "a");
    CHECK(steering.holds("a"));
    CHECK_FALSE(steering.holds("b"));
    CHECK_FALSE(Steering().holder().has_value());
}

TEST_CASE("a holder who loses the connection keeps control for 10 s, and not a microsecond longer") {
    Steering steering = steering_of({"a", "b", "c"});
    CHECK_FALSE(steering.deadline().has_value());
    steering.leave("a", 1h);
    CHECK(steering.holder() == "a");
    CHECK(steering.is_absent());
    CHECK_FALSE(steering.is_here("a"));
    CHECK(steering.deadline() == 1h + 10s);
    steering.advance(1h + 10s - 1us);
    CHECK(steering.holder() == "a");
    SUBCASE("then it passes to who has been here longest") {
        steering.advance(1h + 10s);
        CHECK(steering.holder() == "b");
        CHECK_FALSE(steering.is_absent());
        CHECK_FALSE(steering.deadline().has_value());
    }
    SUBCASE("it passes to who asked, even if another has been here longer") {
        steering.ask("c");
        steering.advance(1h + 9s);
        CHECK(steering.holder() == "a");
        steering.advance(1h + 10s);
        CHECK(steering.holder() == "c");
        CHECK(steering.asking().empty());
    }
    SUBCASE("with the same key it comes back") {
        steering.join("d", "key of b");
        CHECK(steering.holder() == "a");
        steering.join("e", "key of a");
        CHECK(steering.holder() == "e");
        CHECK_FALSE(steering.is_absent());
        steering.advance(2h);
        CHECK(steering.holder() == "e");
    }
    SUBCASE("another may take it meanwhile, and then it does not come back") {
        steering.take("b");
        CHECK(steering.holder() == "b");
        steering.join("e", "key of a");
        CHECK(steering.holder() == "b");
        steering.advance(2h);
        CHECK(steering.holder() == "b");
    }
    SUBCASE("nobody else is here: nobody holds control, and the next who comes does") {
        steering.leave("b", 1h);
        steering.leave("c", 1h);
        steering.advance(1h + 10s);
        CHECK_FALSE(steering.holder().has_value());
        steering.join("d", "");
        CHECK(steering.holder() == "d");
    }
}

TEST_CASE("a client comes back before the server knows that its former connection is dead") {
    Steering steering = steering_of({"a", "b"});
    steering.join("c", "key of a");
    CHECK(steering.holder() == "c");
    steering.leave("a", 1h);
    CHECK(steering.holder() == "c");
    CHECK_FALSE(steering.is_absent());
}

TEST_CASE("from a holder without a resume key control passes on at once") {
    Steering steering;
    for (const char* client : {"a", "b"}) steering.join(client, "");
    steering.leave("a", 1h);
    CHECK(steering.holder() == "b");
    steering.leave("b", 1h);
    CHECK_FALSE(steering.holder().has_value());
}

TEST_CASE("take succeeds whoever holds control; release gives it back to who held it before") {
    Steering steering = steering_of({"a", "b", "c"});
    steering.take("c");
    CHECK(steering.holder() == "c");
    steering.release();
    CHECK(steering.holder() == "a");
    steering.take("b");
    steering.take("c");
    steering.leave("b", 1h);
    steering.release();
    CHECK(steering.holder() == "a");
}

TEST_CASE("release gives control to who asked first; who is alone keeps it") {
    Steering steering = steering_of({"a", "b", "c"});
    for (const char* client : {"c", "b", "c", "a"}) steering.ask(client);
    CHECK(steering.asking() == ClientIds{"c", "b"});  // once each, and not the holder
    steering.release();
    CHECK(steering.holder() == "c");
    CHECK(steering.asking() == ClientIds{"b"});
    steering.decline("b");
    CHECK(steering.asking().empty());
    steering.ask("a");
    steering.leave("a", 1h);
    CHECK(steering.asking().empty());
    steering.leave("b", 1h);
    steering.release();
    CHECK(steering.holder() == "c");
}

TEST_CASE("a holder is quiet 1 s after the last that was steered") {
    Steering steering;
    CHECK(steering.is_quiet(1h));  // there is none
    steering.join("a", "key of a");
    steering.steer(1h);
    CHECK_FALSE(steering.is_quiet(1h + 999ms));
    CHECK(steering.is_quiet(1h + 1s));
    steering.steer(2h);
    steering.leave("a", 2h);
    CHECK(steering.is_quiet(2h));
}
