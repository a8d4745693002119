#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

/// The texts that are written from the description of the command line: help, manual pages, completion.
namespace vrut::server::commands {

/// A term and the sentences about it.
struct Entry {
    std::string term, text;
};

/// A command, or the program, with what its manual says beside its options.
class Command : public CLI::App {
public:
    /// The summary is one imperative sentence. `name` is what follows the program's, or the program's.
    Command(const std::string& summary, const std::string& name);

    std::vector<std::string> description;  ///< paragraphs
    std::vector<Entry> environment, exit_statuses, examples;
};

/// Returns false for a flag.
bool takes_value(const CLI::Option& option);
/// Returns false for what is left out of all texts.
bool is_shown(const CLI::Option& option);

/// Its commands in their order.
std::vector<const Command*> commands_of(const Command& program);

/// What --help prints, in lines of at most 80 columns.
std::string help_text(const Command& command);
/// A page for man(1), in roff with the macros of man(7).
std::string manual_page(const Command& command, const std::string& version);
/// A script for Bash.
std::string bash_completion(const Command& program);

/// Writes a page for the program and for each command to FOLDER/man1, and the completion to
/// FOLDER/completions. Throws std::exception where a file cannot be written.
void write_manual(const Command& program, const std::string& version, const std::filesystem::path& folder);

}  // namespace vrut::server::commands
