#include "recorded_session.hpp"

#include <doctest/doctest.h>

#include <cstdlib>
#include <fstream>

#include "scenes/library.hpp"

namespace vrut::test {

namespace fs = std::filesystem;

std::string session_name() {
    const char* name = std::getenv("VRUT_LOG");
    REQUIRE_MESSAGE(name, "VRUT_LOG has to name a log of tests/data/logs");
    return name;
}

fs::path session_file(const std::string& ending) {
    return fs::path(VRUT_DATA) / "logs" / (session_name() + ending);
}

server::room::EventLog read_session() {
    auto log = server::room::read_event_log(std::ifstream(session_file(".jsonl")), session_file(".jsonl"));
    REQUIRE_MESSAGE(log, log.error());
    return *std::move(log);
}

tl::expected<server::scenes::LoadedScene, std::string> find_scene(const std::string& name,
                                                                  const std::string& sha256,
                                                                  std::optional<protocol::UpAxis>) {
    const fs::path file = fs::path(VRUT_DATA) / "scenes" / name;
    if (server::scenes::sha256_of(file) != sha256)
        return tl::unexpected(name + " has changed since it was recorded");
    return server::scenes::load_scene(file, name);
}

}  // namespace vrut::test
