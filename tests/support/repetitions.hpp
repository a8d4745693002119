#pragma once

namespace vrut::test {

/// How often a trial is repeated: `full` times, or a tenth of that under the sanitizers, which find their
/// faults in a few trials and take ten times as long.
constexpr int repetitions(int full) {
#ifdef VRUT_SANITIZED
    return full / 10;
#else
    return full;
#endif
}

}  // namespace vrut::test
