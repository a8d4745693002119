#include "engine/change_keeper.hpp"

#include <doctest/doctest.h>

#include <map>
#include <stdexcept>
#include <vector>

#include "slow_disk.hpp"

using namespace slow_disk;

namespace {

/// A store on a disk: the patches that it holds, by hash, and those that were set aside.
struct Kept {
    using Patches = std::map<std::string, std::string>;
    std::shared_ptr<Disk> disk = std::make_shared<Disk>();
    std::shared_ptr<Patches> patches = std::make_shared<Patches>();
    std::shared_ptr<Patches> aside = std::make_shared<Patches>();
    std::shared_ptr<std::string> aside_error = std::make_shared<std::string>();

    ChangeKeeper::Store store() const {
        return {[disk = disk, patches = patches](const std::string& scene, const std::string& patch) {
                    disk->pass();
                    const std::lock_guard lock(disk->mutex);
                    if (!disk->error.empty()) throw std::runtime_error(disk->error);
                    (*patches)[scene] = patch;
                },
                [*this](const std::string& scene, const std::string& unusable, const std::string& date) {
                    disk->pass();
                    const std::lock_guard lock(disk->mutex);
                    const auto found = patches->find(scene);
                    if (found == patches->end() || (found->second != unusable && found->second != "garbage"))
                        return std::string();
                    if (!aside_error->empty()) throw std::runtime_error(*aside_error);
                    CHECK(date.starts_with("20"));
                    (*aside)[scene] += found->second;
                    patches->erase(found);
                    return "aside of " + scene;
                }};
    }
    std::string of(const std::string& scene) const { return of(scene, *patches); }
    std::string set_aside(const std::string& scene) const { return of(scene, *aside); }

private:
    std::string of(const std::string& scene, const Patches& all) const {
        const std::lock_guard lock(disk->mutex);
        const auto found = all.find(scene);
        return found == all.end() ? "" : found->second;
    }
};

const ChangeKeeper::Events kNothing{[](const std::string& why) { FAIL(why); },
                                    [](const std::string& file) { FAIL(file); }};

/// What a keeper reports.
struct Told {
    std::vector<std::string> failed, set_aside;
    ChangeKeeper::Events events() {
        return {[this](const std::string& why) { failed.push_back(why); },
                [this](const std::string& file) { set_aside.push_back(file); }};
    }
};

using Lines = std::vector<std::string>;

}  // namespace

TEST_CASE("changes are kept a second after the first one") {
    Results results;
    const Kept kept;
    ChangeKeeper keeper(kept.store(), results.post(), kNothing);
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
        ChangeKeeper keeper(kept.store(), results.post(), kNothing);
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
    Told told;
    ChangeKeeper keeper(kept.store(), results.post(), told.events());
    const auto keep = [&](const std::string& error) {
        kept.disk->error = error;
        keeper.keep("ab", "1");
        results.use_next();
    };
    keep("disk full");
    keep("disk full");
    CHECK(told.failed == Lines{"disk full"});
    keep("");
    CHECK(kept.of("ab") == "1");
    keep("disk full");
    CHECK(told.failed.size() == 2);
    keep("another fault");
    CHECK(told.failed.size() == 3);
}

TEST_CASE("changes that cannot be used are set aside, before others are written in their place") {
    Results results;
    const Kept kept;
    Told told;
    ChangeKeeper keeper(kept.store(), results.post(), told.events());
    (*kept.patches)["ab"] = "of a newer version";
    kept.disk->block(true);
    keeper.set_aside("ab", "of a newer version");
    kept.disk->await_call();
    keeper.keep("ab", "1");
    kept.disk->block(false);
    results.use_next();
    CHECK(told.set_aside == Lines{"aside of ab"});
    results.use_next();
    CHECK(kept.of("ab") == "1");
    CHECK(kept.set_aside("ab") == "of a newer version");
    keeper.keep("ab", "2");
    results.use_next();
    CHECK(kept.of("ab") == "2");
    CHECK(kept.set_aside("ab") == "of a newer version");
    CHECK(told.set_aside.size() == 1);
    CHECK(told.failed.empty());
}

TEST_CASE("changes that cannot be set aside are not written over, and that is told") {
    Results results;
    const Kept kept;
    Told told;
    ChangeKeeper keeper(kept.store(), results.post(), told.events());
    (*kept.patches)["ab"] = "of a newer version";
    *kept.aside_error = "the folder is read-only";
    keeper.set_aside("ab", "of a newer version");
    results.use_next();
    CHECK(told.failed == Lines{"the folder is read-only"});
    for (const char* patch : {"1", "2"}) {
        keeper.keep("ab", patch);
        results.use_next();
        CHECK(kept.of("ab") == "of a newer version");
    }
    keeper.keep("cd", "3");  // those of other scenes are kept
    results.use_next();
    CHECK(kept.of("cd") == "3");
    CHECK(told.failed.size() == 1);
    *kept.aside_error = "";
    keeper.keep("ab", "4");
    results.use_next();
    CHECK(kept.of("ab") == "4");
    CHECK(kept.set_aside("ab") == "of a newer version");
    CHECK(told.set_aside == Lines{"aside of ab"});
}

TEST_CASE("changes that cannot be read are set aside, though nobody has opened their scene here") {
    Results results;
    const Kept kept;
    Told told;
    ChangeKeeper keeper(kept.store(), results.post(), told.events());
    (*kept.patches)["ab"] = "garbage";
    keeper.keep("ab", "1");
    results.use_next();
    CHECK(kept.of("ab") == "1");
    CHECK(kept.set_aside("ab") == "garbage");
    CHECK(told.set_aside == Lines{"aside of ab"});
}

TEST_CASE("changes: an end sets aside what cannot be used, once") {
    Results results;
    const Kept kept;
    {
        ChangeKeeper keeper(kept.store(), results.post(), kNothing);
        (*kept.patches)["ab"] = "garbage";
        kept.disk->block(true);
        keeper.set_aside("ab", "garbage");
        kept.disk->await_call();
        keeper.keep("ab", "1");
        kept.disk->block(false);
    }
    CHECK(kept.of("ab") == "1");
    CHECK(kept.set_aside("ab") == "garbage");
}

TEST_CASE("changes: an end does not wait for a disk that hangs") {
    Results results;
    const Kept kept;
    std::optional<ChangeKeeper> keeper;
    keeper.emplace(kept.store(), results.post(), kNothing);
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
    ChangeKeeper keeper({}, results.post(), kNothing);
    keeper.changed(Clock::time_point{});
    CHECK_FALSE(keeper.due());
    keeper.keep("ab", "1");
}
