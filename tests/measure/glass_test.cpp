#include "measure/glass.hpp"

#include <doctest/doctest.h>

using namespace vrut::server::measure;

TEST_CASE("links are read") {
    const auto link = parse_link("100,2");
    REQUIRE(link);
    CHECK(link->name == "100,2");
    CHECK(link->round_trip_ms == 100);
    CHECK(link->bytes_per_second == 250'000);
    CHECK(link->loss == 0);
    CHECK(parse_link("0,1000,2.5")->loss == 0.025);
}

TEST_CASE("what is no link is named") {
    for (const char* text : {"", "100", "100,", "100,2,", "100,2,1,1", "100;2", "x,2", "-1,2", "100,0",
                             "1e9,2", "100,2,91", "nan,2", "100,nan", "100,2,-1", "100,2 Mbit"}) {
        CAPTURE(text);
        const auto link = parse_link(text);
        REQUIRE_FALSE(link);
        CHECK(link.error().ends_with("found '" + std::string(text) + "'"));
    }
}
