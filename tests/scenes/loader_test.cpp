#include "scenes/loader.hpp"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <unistd.h>

#include <csignal>
#include <memory>
#include <thread>

#include "base/detached_thread.hpp"
#include "temporary_folder.hpp"

using namespace vrut::server::scenes;

TEST_CASE("a loader that ends leaves a thread behind whose file does not open, and hears no more of it") {
    std::signal(SIGIO, SIG_IGN);  // tells that somebody waits for the lease below
    const TemporaryFolder folder;
    const auto scene = folder.write("room.vrut", "vrut-text 1\nnode 0 \"Room\" root end\n");
    const int leased = open(scene.c_str(), O_RDWR | O_CLOEXEC);
    REQUIRE(fcntl(leased, F_SETLEASE, F_WRLCK) == 0);
    auto listener = std::make_shared<int>(0);
    const std::weak_ptr<int> heard = listener;
    {
        SceneLoader loader([](const SceneLoading&) {}, [listener](const SceneLoaded&) { ++*listener; });
        loader.start(scene, {"room.vrut"}, "renderer", {});
        CHECK(loader.busy());
        listener.reset();
    }
    CHECK(heard.expired());  // while the thread hangs
    close(leased);           // now the file opens
    while (vrut::server::base::detached_threads() > 0) std::this_thread::yield();
}
