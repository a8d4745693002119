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
    /// Of scenes, named by LoadedScene::changes_key(). Both throw std::exception with a sentence. On any
    /// thread.
    struct Store {
        /// Keeps a patch of the state in place of what is kept.
        std::function<void(const std::string& scene, const std::string& patch)> write;
        /// See scenes::set_changes_aside().
        std::function<std::string(const std::string& scene, const std::string& unusable,
                                  const std::string& date)>
            set_aside;
    };
    struct Events {
        /// Nothing can be kept, and why; not again before something else comes of it.
        std::function<void(const std::string& why)> failed;
        /// What cannot be used is in this file from now on.
        std::function<void(const std::string& file)> set_aside;
    };

    /// Without a store nothing is kept.
    ChangeKeeper(Store store, std::shared_ptr<ResultPost> post, Events events);
    /// What waits is written if the disk takes it within a second.
    ~ChangeKeeper();
    ChangeKeeper(const ChangeKeeper&) = delete;
    ChangeKeeper& operator=(const ChangeKeeper&) = delete;

    /// Something has changed: keep() is due a second after the first change that is not kept.
    void changed(base::Clock::time_point now);
    std::optional<base::Clock::time_point> due() const { return due_; }
    void keep(const std::string& scene, std::string patch);
    /// What is kept of a scene cannot be used: it is set aside, and nothing is written before that is done.
    /// `unusable` is its text, empty if it cannot be read.
    void set_aside(const std::string& scene, const std::string& unusable);
    /// What was given to keep() last, of the last few scenes: a disk may not have it yet.
    std::optional<std::string> newest(const std::string& scene) const;

private:
    struct Writer;
    /// What came of one write.
    struct Result {
        std::string set_aside;               ///< the file; empty: none
        std::optional<std::string> why_not;  ///< none: it is done
    };
    void write_next();
    void report(const Result& result);

    std::shared_ptr<Writer> writer_;  ///< null: nothing is kept
    std::shared_ptr<ResultPost> post_;
    Events events_;
    std::optional<base::Clock::time_point> due_;
    base::Clock::time_point kept_at_{};
    std::map<std::string, std::optional<std::string>> waiting_;  ///< patches by scene; none: none is known
    std::deque<std::pair<std::string, std::string>> newest_;     ///< scenes and patches, the latest first
    bool writes_ = false;
    std::optional<std::string> failed_;  ///< why the last write has failed
};

}  // namespace vrut::server::engine
