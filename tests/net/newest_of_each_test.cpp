#include "net/newest_of_each.hpp"

#include <doctest/doctest.h>

using namespace vrut;
using server::net::NewestOfEach;
using server::net::Text;

namespace {

Text text(const char* words) { return std::make_shared<const std::string>(words); }

}  // namespace

TEST_CASE("of what is said about each the newest waits, in the place of the first") {
    NewestOfEach waiting;
    CHECK(waiting.empty());
    for (int i = 0; i < 1000; ++i) {
        waiting.put("a", text("old"));
        waiting.put("b", text("b"));
    }
    waiting.put("a", text("new"));
    CHECK(waiting.size() == 2);
    CHECK(*waiting.take() == "new");
    waiting.put("a", text("newer"));
    CHECK(*waiting.take() == "b");
    CHECK(*waiting.take() == "newer");
    CHECK(waiting.empty());
}

TEST_CASE("at most 256 wait, the newest of them") {
    NewestOfEach waiting;
    for (int i = 0; i < 300; ++i) waiting.put(std::to_string(i), text(std::to_string(i).c_str()));
    CHECK(waiting.size() == NewestOfEach::kMost);
    CHECK(*waiting.take() == "44");
}
