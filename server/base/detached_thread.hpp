#pragma once

#include <atomic>
#include <thread>
#include <utility>

namespace vrut::server::base {

/// How many threads of run_detached() have not ended. While there are any a process ends by std::_Exit():
/// std::exit() takes apart what they use, as OpenSSL.
inline std::atomic<int>& detached_threads() {
    static std::atomic<int> count{0};
    return count;
}

/// Runs on a thread of its own, for which nobody waits, what may hang for ever in a system call, as reading
/// from a disk that does not answer does. `work` owns what it uses. Throws std::system_error where no thread
/// can be had.
template <class Work>
void run_detached(Work work) {
    class Counted {
    public:
        Counted() { ++detached_threads(); }
        Counted(Counted&& other) noexcept : counts_(std::exchange(other.counts_, false)) {}
        Counted& operator=(Counted&&) = delete;
        ~Counted() {
            if (counts_) --detached_threads();
        }

    private:
        bool counts_ = true;
    };
    std::thread([counted = Counted(), work = std::move(work)]() mutable { work(); }).detach();
}

}  // namespace vrut::server::base
