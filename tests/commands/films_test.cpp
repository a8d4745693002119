// Films of the program, as its users start it.
#include <doctest/doctest.h>
#include <sys/wait.h>

#include <csignal>
#include <fstream>

#include "decoded_film.hpp"
#include "io/image/image_file.hpp"
#include "program.hpp"
#include "temporary_folder.hpp"
#include "test_client.hpp"

using namespace vrut;
using namespace vrut::test;
namespace fs = std::filesystem;

namespace {

const std::string kScene = VRUT_CARS "/car-20k.vrut";
constexpr double kNear = 3;  // mean of 255: what encoding changes, most of it by colours of 2x2 pixels
constexpr auto kFlight =
    R"({"keyframes": [{"at": 400, "camera": {"eye": [4, 1, 3], "focus": [0, 0.6, 0]}}]})";

/// The exit status.
int run(const std::vector<std::string>& words) {
    Program program(words);
    const auto status = program.wait(60s);
    INFO(program.output());
    REQUIRE(status.has_value());
    CHECK(WIFEXITED(*status));
    return WEXITSTATUS(*status);
}

std::vector<std::string> operator+(std::vector<std::string> words, const std::vector<std::string>& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

/// A folder with a flight in it.
struct Studio {
    Studio() { folder.write("flight.json", kFlight); }

    std::string path(const std::string& name) const { return (folder.path() / name).string(); }
    std::vector<std::string> render(const std::string& output) const {
        return {"render", kScene, "-o", path(output), "--size", "256x144"};
    }
    std::vector<std::string> film(const std::string& output) const {
        return render(output) + std::vector<std::string>{"--keyframes", path("flight.json")};
    }
    std::vector<std::string> replay(const std::string& log, const std::string& output) const {
        const std::string data = VRUT_DATA;
        return {"replay",  data + "/logs/" + log + ".jsonl",
                "--scene", data + "/scenes/room.vrut",
                "--film",  path(output)};
    }
    scene::Image image(const std::string& name) const {
        auto image = io::read_image_file(folder.path() / name);
        REQUIRE_MESSAGE(image, image.error());
        return *std::move(image);
    }
    std::size_t files() const {
        return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder.path()), {}));
    }

    TemporaryFolder folder;
};

/// How many images differ from the one before.
std::size_t changes_in(const std::vector<scene::Image>& images) {
    std::size_t changes = 0;
    for (std::size_t i = 1; i < images.size(); ++i)
        if (mean_difference(images[i - 1], images[i]) > kNear / 10) ++changes;
    return changes;
}

}  // namespace

TEST_CASE("a film of a flight has an image for each of its times, from the first view to the last keyframe") {
    const Studio studio;
    CHECK(run(studio.film("film.mp4")) == 0);
    CHECK(run(studio.render("first.png")) == 0);
    CHECK(run(studio.render("last.png") + std::vector<std::string>{"--eye", "4,1,3", "--focus", "0,0.6,0"}) ==
          0);
    const DecodedFilm film = decode_film(studio.path("film.mp4"));
    CHECK(film.images_per_second == 30);
    REQUIRE(film.images.size() == 13);
    CHECK(film.images[0].width == 256);
    CHECK(film.images[0].height == 144);
    CHECK(mean_difference(film.images.front(), studio.image("first.png")) < kNear);
    CHECK(mean_difference(film.images.back(), studio.image("last.png")) < kNear);
    CHECK(changes_in(film.images) == 12);
    CHECK(run(studio.film("again.mp4")) == 0);
    CHECK(studio.folder.read("film.mp4") == studio.folder.read("again.mp4"));
}

TEST_CASE("--fps and --frames choose how many images there are, in one file and in several") {
    const Studio studio;
    CHECK(run(studio.film("film.mp4") + std::vector<std::string>{"--fps", "5"}) == 0);
    const DecodedFilm slow = decode_film(studio.path("film.mp4"));
    CHECK(slow.images.size() == 3);
    CHECK(slow.images_per_second == 5);
    CHECK(run(studio.film("film.mp4") + std::vector<std::string>{"--fps", "50", "--frames", "4"}) == 0);
    const DecodedFilm fast = decode_film(studio.path("film.mp4"));
    CHECK(fast.images.size() == 4);
    CHECK(fast.images_per_second == 50);
    CHECK(run(studio.film("image.png") + std::vector<std::string>{"--fps", "10"}) == 0);
    CHECK(fs::exists(studio.path("image-0005.png")));
    CHECK_FALSE(fs::exists(studio.path("image-0006.png")));
}

TEST_CASE("a film that a signal stops leaves nothing, and the old one as it was") {
    const Studio studio;
    studio.folder.write("film.mp4", "old");
    Program program(studio.film("film.mp4") + std::vector<std::string>{"--frames", "100000"});
    REQUIRE(eventually([&] { return studio.files() == 3; }, 30s));  // it is begun
    program.signal(SIGTERM);
    const auto status = program.wait(20s);
    REQUIRE(status.has_value());
    CHECK(WEXITSTATUS(*status) == 1);
    CHECK(program.output().find("film.mp4: a signal stopped the film at image ") != std::string::npos);
    CHECK(studio.folder.read("film.mp4") == "old");
    CHECK(studio.files() == 2);
}

TEST_CASE("a film goes on where nohup has the end of the terminal ignored") {
    const Studio studio;
    std::signal(SIGHUP, SIG_IGN);
    Program program(studio.film("film.mp4") + std::vector<std::string>{"--frames", "100"});
    std::signal(SIGHUP, SIG_DFL);
    REQUIRE(eventually([&] { return studio.files() == 2; }, 30s));  // it is begun
    program.signal(SIGHUP);
    const auto status = program.wait(60s);
    REQUIRE(status.has_value());
    CHECK_MESSAGE((WIFEXITED(*status) && WEXITSTATUS(*status) == 0), program.output());
    CHECK(decode_film(studio.path("film.mp4")).images.size() == 100);
}

TEST_CASE("a film of a session ends at what the session ended at") {
    const Studio studio;
    const auto size = std::vector<std::string>{"--size", "320x200"};
    CHECK(run(studio.replay("orbit", "film.mp4") + size) == 0);
    const DecodedFilm film = decode_film(studio.path("film.mp4"));
    CHECK(film.images.size() == 16);  // 478.1 ms at 30 a second, and the end
    const auto end = io::read_image_file(VRUT_DATA "/logs/orbit.png");
    REQUIRE(end);
    CHECK(mean_difference(film.images.back(), *end) < kNear);
    CHECK(mean_difference(film.images.front(), *end) > 2 * kNear);
    CHECK(run(studio.replay("orbit", "again.mp4") + size) == 0);
    CHECK(studio.folder.read("film.mp4") == studio.folder.read("again.mp4"));
}

TEST_CASE("what flies in a session flies in its film between the frames that were drawn") {
    const Studio studio;
    CHECK(run(studio.replay("begun-in-flight", "film.mp4") + std::vector<std::string>{"--fps", "100"}) == 0);
    constexpr std::size_t kDrawn = 38;
    CHECK(changes_in(decode_film(studio.path("film.mp4")).images) > kDrawn);
}

TEST_CASE("a film of a session goes on through another scene, in the size of the first view") {
    const Studio studio;
    CHECK(run(studio.replay("other-scene", "film.mp4") + std::vector<std::string>{"--fps", "60"}) == 0);
    const DecodedFilm film = decode_film(studio.path("film.mp4"));
    REQUIRE(film.images.size() == 11);
    CHECK(film.images[0].width == 400);
    CHECK(film.images[0].height == 250);
    CHECK(mean_difference(film.images.front(), film.images.back()) > 2 * kNear);
    CHECK(run(studio.replay("other-scene", "image.png") + std::vector<std::string>{"--fps", "60"}) == 0);
    CHECK(mean_difference(film.images.back(), studio.image("image-0011.png")) < kNear);
    CHECK(studio.files() == 13);
}
