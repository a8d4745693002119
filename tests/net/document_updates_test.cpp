#include "net/document_updates.hpp"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

using namespace vrut;
using namespace vrut::server;
using server::net::DocumentUpdates;
using server::net::Text;

namespace {

struct Updated {
    /// The state goes on to look from here; the client `by` has made it so since revision `since`.
    void look_from(double x, const std::string& by, std::int64_t since) {
        state.camera.eye.x = x;
        before = updates.newest() ? updates.newest() : std::make_shared<const protocol::StateDocument>();
        updates.set(protocol::StateDocument::next(*before, state), by, since);
    }
    nlohmann::json from(const protocol::StateDocument* known) {
        return nlohmann::json::parse(*updates.update_from(known, metrics));
    }

    observe::Metrics metrics;
    protocol::State state;
    DocumentUpdates updates;
    std::shared_ptr<const protocol::StateDocument> before;
};

}  // namespace

TEST_CASE("who knows nothing gets the state, who knows a revision the difference, and by whom") {
    Updated u;
    u.look_from(1, "", 1);
    CHECK(u.from(nullptr)["type"] == "state");
    u.look_from(2, "c1", 2);
    const auto second = u.before;
    nlohmann::json patch = u.from(second.get());
    CHECK(patch["type"] == "patch");
    CHECK(patch["patch"]["camera"]["eye"][0] == 2.0);
    CHECK(patch["by"] == "c1");
    u.look_from(3, "c2", 3);
    CHECK(u.from(u.before.get())["by"] == "c2");
    CHECK_FALSE(u.from(second.get()).contains("by"));  // of two authors
}

TEST_CASE("an update is encoded once for all who know the same") {
    Updated u;
    u.look_from(1, "", 1);
    u.look_from(2, "c1", 2);
    const Text first = u.updates.update_from(u.before.get(), u.metrics);
    CHECK(u.updates.update_from(u.before.get(), u.metrics) == first);
    CHECK(u.updates.update_from(nullptr, u.metrics) != first);
    u.look_from(3, "c1", 2);
    CHECK(u.updates.update_from(u.before.get(), u.metrics) != first);
}

TEST_CASE("a large state is kept only while somebody is being sent it") {
    Updated u;
    u.state.notices.push_back({"test", std::string(2'000'000, 'x')});
    u.look_from(1, "", 1);
    Text whole = u.updates.update_from(nullptr, u.metrics);
    CHECK(u.updates.update_from(nullptr, u.metrics) == whole);
    CHECK(u.metrics.bytes_held > 2'000'000);
    whole.reset();
    CHECK(u.metrics.bytes_held == 0);
}
