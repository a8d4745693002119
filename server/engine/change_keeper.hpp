#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "base/clock.hpp"
#include "engine/file_work.hpp"

namespace vrut::server::engine {

/// Keeps what clients have changed of scenes, on a thread of its own, for which nothing waits: one write at a
/// time, the newest of each scene. To be used on one thread, which also gets the results.
class ChangeKeeper {
public:
    /// Of a scene, named by LoadedScene::changes_key(), and a patch of the state. Throws std::exception with
    /// a sentence. On any thread.
    using Store = std::function<void(const std::string& scene, const std::string& patch)>;
    /// A write has failed, and why; not again before one has succeeded.
    using OnFailed = std::function<void(const std::string& why)>;

    /// Without a store nothing is kept.
    ChangeKeeper(Store store, std::shared_ptr<ResultPost> post, OnFailed on_failed);
    /// What waits is written if the disk takes it within a second.
    ~ChangeKeeper();
    ChangeKeeper(const ChangeKeeper&) = delete;
    ChangeKeeper& operator=(const ChangeKeeper&) = delete;

    /// Something has changed: keep() is due a second after the first change that is not kept.
    void changed(base::Clock::time_point now);
    std::optional<base::Clock::time_point> due() const { return due_; }
    void keep(const std::string& scene, std::string patch);
    /// What was given to keep() last, of the last few scenes: a disk may not have it yet.
    std::optional<std::string> newest(const std::string& scene) const;

private:
    struct Writer;
    void write_next();
    void report(const std::optional<std::string>& why_not);

    std::shared_ptr<Writer> writer_;  ///< null: nothing is kept
    std::shared_ptr<ResultPost> post_;
    OnFailed on_failed_;
    std::optional<base::Clock::time_point> due_;
    base::Clock::time_point kept_at_{};
    std::map<std::string, std::string> waiting_;              ///< patches by scene
    std::deque<std::pair<std::string, std::string>> newest_;  ///< scenes and patches, the latest first
    bool writes_ = false, failed_ = false;
};

}  // namespace vrut::server::engine
