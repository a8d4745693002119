#include "engine/change_keeper.hpp"

#include <doctest/doctest.h>

#include <map>
#include <stdexcept>
#include <vector>

#include "slow_disk.hpp"

using namespace slow_disk;

namespace {

/// A store on a disk: the patches that it holds, by hash.
struct Kept {
    std::shared_ptr<Disk> disk = std::make_shared<Disk>();
    std::shared_ptr<std::map<std::string, std::string>> patches =
        std::make_shared<std::map<std::string, std::string>>();

    ChangeKeeper::Store store() const {
        return [disk = disk, patches = patches](const std::string& scene, const std::string& patch) {
            disk->pass();
            const std::lock_guard lock(disk->mutex);
            if (!disk->error.empty()) throw std::runtime_error(disk->error);
            (*patches)[scene] = patch;
        };
    }
    std::string of(const std::string& scene) const {
        const std::lock_guard lock(disk->mutex);
        const auto found = patches->find(scene);
        return found == patches->end() ? "" : found->second;
    }
};

void never_fails(const std::string& why) { FAIL(why); }

}  // namespace

TEST_CASE("changes are kept a second after the first one") {
    Results results;
    const Kept kept;
    ChangeKeeper keeper(kept.store(), results.post(), never_fails);
    CHECK_FALSE(keeper.due());
    const Clock::time_point first{};
    keeper.changed(first);
    keeper.changed(first + 500ms);
    CHECK(keeper.due() == first + 1s);
    keeper.keep("ab", "1");
    CHECK_FALSE(keeper.due());
    results.use_next();
    CHECK(kept.of("ab") == "1");
}

TEST_CASE("changes: while the disk is slow only the newest of each scene waits, and the end writes it") {
    Results results;
    const Kept kept;
    {
        ChangeKeeper keeper(kept.store(), results.post(), never_fails);
        kept.disk->block(true);
        keeper.keep("ab", "1");
        kept.disk->await_call();
        keeper.keep("ab", "2");
        keeper.keep("cd", "3");
        keeper.keep("ab", "4");
        kept.disk->block(false);
    }
    CHECK(kept.of("ab") == "4");
    CHECK(kept.of("cd") == "3");
}

TEST_CASE("changes that cannot be kept are told once, until they can") {
    Results results;
    const Kept kept;
    std::vector<std::string> told;
    ChangeKeeper keeper(kept.store(), results.post(), [&](const std::string& why) { told.push_back(why); });
    const auto keep = [&](const std::string& error) {
        kept.disk->error = error;
        keeper.keep("ab", "1");
        results.use_next();
    };
    keep("disk full");
    keep("disk full");
    CHECK(told == std::vector<std::string>{"disk full"});
    keep("");
    CHECK(kept.of("ab") == "1");
    keep("disk full");
    CHECK(told.size() == 2);
}

TEST_CASE("changes: an end does not wait for a disk that hangs") {
    Results results;
    const Kept kept;
    std::optional<ChangeKeeper> keeper;
    keeper.emplace(kept.store(), results.post(), never_fails);
    kept.disk->block(true);
    keeper->keep("ab", "1");
    kept.disk->await_call();
    keeper.reset();  // within a second
    CHECK(kept.of("ab").empty());
    kept.disk->block(false);
    kept.disk->await_no_call();
}

TEST_CASE("changes: without a store nothing is kept") {
    Results results;
    ChangeKeeper keeper({}, results.post(), never_fails);
    keeper.changed(Clock::time_point{});
    CHECK_FALSE(keeper.due());
    keeper.keep("ab", "1");
}
