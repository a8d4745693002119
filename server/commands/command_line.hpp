#pragma once

#include <memory>

#include "commands/commands.hpp"
#include "manual.hpp"

namespace vrut::server::commands {

/// Exit statuses.
constexpr int kDone = 0, kFailed = 1, kWrongUsage = 2;

/// What the options of all commands fill.
struct Arguments {
    ServeArguments serve;
    EdgeArguments edge;
    RenderArguments render;
    WorkerArguments worker;
    ReplayArguments replay;
    InfoArguments info;
    ConvertArguments convert;
    CompareArguments compare;
    CuesArguments cues;
    ChartArguments chart;
};

/// The program's commands and options, each beside its sentence. Parsing fills `arguments`, which must
/// outlive the result, and runs the command.
std::shared_ptr<Command> describe_program(Arguments& arguments);

}  // namespace vrut::server::commands
