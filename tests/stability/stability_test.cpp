// Every method pushed past its limit, in short. The program `stability` does it in full, as a page.
#include <doctest/doctest.h>

#include "handles.hpp"
#include "study.hpp"

using namespace vrut;
using namespace vrut::stability;

TEST_CASE("each method holds up to its limit, and beyond it what takes over does") {
    {
        Renderer renderer(std::nullopt, true);
        const Laboratory laboratory{renderer, Form::brief};
        for (const Topic& topic : topics()) {
            CAPTURE(topic.name);
            const Study study = topic.study(laboratory);
            const auto wrong = contradiction(study);
            CHECK_MESSAGE(!wrong, *wrong);
            CHECK(study.measure.size() <= 60);  // what stands along the height of its chart
            for (const std::string& message : renderer.take_messages()) FAIL_CHECK(message);
        }
    }
    CHECK(live_gl_objects() == 0);
}

TEST_CASE("a study that is not as it says is told so") {
    const Study good{"x", "", "", "", 1, 10, {"m", {{1, 0.5}, {10, 2}}}, Curve{"s", {{1, 0}, {10, 1}}},
                     "",  ""};
    CHECK(!contradiction(good));
    const auto with = [&](auto change) {
        Study study = good;
        change(study);
        return contradiction(study).value_or("");
    };
    CHECK(with([](Study& study) { study.method.points.clear(); }) == "'m' was not measured");
    CHECK(with([](Study& study) { study.method.points[0].y = std::nan(""); }) == "'m' is nan at 1.000000");
    CHECK(with([](Study& study) { study.method.points[0].y = 1.5; }) ==
          "'m' is 1.500000 at 1.000000, before its limit");
    CHECK(with([](Study& study) { study.method.points[1].y = 1; }) ==
          "'m' is 1.000000 at 10.000000, and has not failed");
    CHECK(with([](Study& study) { study.successor->points[1].y = 2; }) ==
          "'s' is 2.000000 at 10.000000, and fails, too");
    CHECK(with([](Study& study) { study.limit = 11; }) == "'m' is 2.000000 at 10.000000, before its limit");
    CHECK(with([](Study& study) { study.method.points.pop_back(); }) == "'m' was not pushed so far");
    CHECK(with([](Study& study) { study.limit.reset(); }) ==
          "'m' is 2.000000 at 10.000000, before its limit");
}
