#include "manual.hpp"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <set>
#include <sstream>

#include "base/files.hpp"

namespace vrut::server::commands {

namespace {

struct Section {
    std::string title;
    std::vector<Entry> entries;
};

/// What help and manual page hold.
struct Page {
    std::string command;  ///< "vrut-preview serve"
    std::string summary, usage;
    std::vector<std::string> description;
    std::vector<Section> options;  ///< arguments too, and the program's commands
    Section environment, exit_statuses, examples;
};

std::string full_name(const Command& command) {
    const CLI::App* parent = command.get_parent();
    return (parent ? parent->get_name() + " " : "") + command.get_name();
}

/// "-o, --output FILE".
std::string term_of(const CLI::Option& option) {
    if (option.get_positional()) return option.get_name(true);
    std::string term;
    for (const std::string& name : option.get_snames()) term += "-" + name + ", ";
    for (const std::string& name : option.get_lnames()) term += "--" + name + ", ";
    term.erase(term.size() - 2);
    return takes_value(option) ? term + " " + option.get_type_name() : term;
}

/// In an order that does not change from start to start.
std::set<std::string> names_of(const std::set<CLI::Option*>& options) {
    std::set<std::string> names;
    for (const CLI::Option* option : options) names.insert(option->get_name());
    return names;
}

std::string text_of(const CLI::Option& option) {
    std::string text = option.get_description();
    if (option.get_required() && option.nonpositional()) text += " Required.";
    if (option.get_expected_max() == CLI::detail::expected_max_vector_size)
        text += " May be given several times.";
    for (const std::string& name : names_of(option.get_needs())) text += " Only with " + name + ".";
    for (const std::string& name : names_of(option.get_excludes())) text += " Not with " + name + ".";
    if (!option.get_default_str().empty()) text += " Default: " + option.get_default_str() + ".";
    return text;
}

std::string usage_of(const Command& command) {
    std::string usage = full_name(command);
    if (!command.get_parent()) return usage + " COMMAND [OPTIONS]";
    usage += " [OPTIONS]";
    for (const CLI::Option* option : command.get_options([](auto* each) { return each->get_positional(); })) {
        const std::string name = option->get_name(true);
        usage += option->get_required() ? " " + name : " [" + name + "]";
        if (option->get_expected_max() == CLI::detail::expected_max_vector_size) usage += "...";
    }
    return usage;
}

/// The arguments first, then each group of options. That of --help, which CLI11 adds first, is the last.
std::vector<Section> options_of(const Command& command) {
    std::vector<Section> sections;
    const auto add = [&](const std::string& title, const auto& belongs) {
        Section section{title, {}};
        for (const CLI::Option* option : command.get_options(belongs))
            section.entries.push_back({term_of(*option), text_of(*option)});
        if (!section.entries.empty()) sections.push_back(std::move(section));
    };
    add("Arguments", [](auto* option) { return is_shown(*option) && option->get_positional(); });
    std::vector<std::string> groups = command.get_groups();
    std::rotate(groups.begin(), groups.begin() + 1, groups.end());
    for (const std::string& group : groups)
        add(group + " options", [&](auto* option) {
            return is_shown(*option) && option->nonpositional() && option->get_group() == group;
        });
    return sections;
}

Page page_of(const Command& command) {
    Page page{.command = full_name(command),
              .summary = command.get_description(),
              .usage = usage_of(command),
              .description = command.description,
              .options = options_of(command),
              .environment = {"Environment", command.environment},
              .exit_statuses = {"Exit status", command.exit_statuses},
              .examples = {"Examples", command.examples}};
    Section list{"Commands", {}};
    for (const Command* each : commands_of(command))
        list.entries.push_back({each->get_name(), each->get_description()});
    if (!list.entries.empty()) page.options.insert(page.options.begin(), std::move(list));
    return page;
}

// --- help

constexpr std::size_t kColumns = 80;

/// The words in lines that begin at a column, the first of which stands there already.
std::string wrapped(const std::string& text, std::size_t column) {
    std::istringstream words(text);
    std::string lines;
    std::size_t at = column;
    for (std::string word; words >> word;) {
        if (at > column && at + 1 + word.size() > kColumns) {
            lines += "\n" + std::string(column, ' ');
            at = column;
        }
        if (at > column) {
            lines += ' ';
            ++at;
        }
        lines += word;
        at += word.size();
    }
    return lines + "\n";
}

std::string help_section(const Section& section, std::size_t column) {
    if (section.entries.empty()) return {};
    std::string text = "\n" + section.title + ":\n";
    for (const auto& [term, about] : section.entries) {
        std::string start = "  " + term;
        const bool fits = start.size() + 2 <= column;
        start += fits ? "" : "\n";
        start += std::string(fits ? column - start.size() : column, ' ');
        text += start + wrapped(about, column);
    }
    return text;
}

// --- manual page

/// As troff takes it for itself and shows it: hyphens can be copied as the minus that a shell wants.
std::string escaped(const std::string& text) {
    std::string out;
    for (const char c : text) switch (c) {
            case '\\':
                out += "\\e";
                break;
            case '-':
                out += "\\-";
                break;
            case '\'':
                out += "\\(aq";
                break;
            case '`':
                out += "\\(ga";
                break;
            case '"':
                out += "\\(dq";
                break;
            case '^':
                out += "\\(ha";
                break;
            case '~':
                out += "\\(ti";
                break;
            default:
                out += c;
        }
    return out.starts_with('.') ? "\\&" + out : out;
}

/// What is typed as it stands is bold; a word with a capital stands for another, and is italic.
std::string highlighted(const std::string& term) {
    std::istringstream words(term);
    std::string out;
    for (std::string word; words >> word;) {
        const bool stands_for_another =
            !word.starts_with('-') &&
            std::any_of(word.begin(), word.end(), [](unsigned char c) { return std::isupper(c) != 0; });
        out += (out.empty() ? "" : " ") + std::string(stands_for_another ? "\\fI" : "\\fB") + escaped(word) +
               "\\fR";
    }
    return out;
}

std::string upper(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    return text;
}

std::string roff_entries(const std::vector<Entry>& entries) {
    std::string text;
    for (const auto& [term, about] : entries)
        text += ".TP\n" + highlighted(term) + "\n" + escaped(about) + "\n";
    return text;
}

std::string roff_section(const Section& section) {
    return section.entries.empty() ? ""
                                   : ".SH " + upper(section.title) + "\n" + roff_entries(section.entries);
}

/// The name of a command's page: "vrut-preview-serve".
std::string page_name(const Command& command) {
    std::string name = full_name(command);
    std::replace(name.begin(), name.end(), ' ', '-');
    return name;
}

/// The pages of the program's commands, or that of the program.
std::string see_also(const Command& command) {
    std::vector<std::string> names;
    for (const Command* each : commands_of(command)) names.push_back(page_name(*each));
    if (const CLI::App* parent = command.get_parent()) names.push_back(parent->get_name());
    std::string text = ".SH SEE ALSO\n";
    for (const std::string& name : names)
        text += ".BR " + escaped(name) + " (1)" + (name == names.back() ? "\n" : ",\n");
    return text;
}

void write_text(const std::filesystem::path& path, const std::string& text) {
    std::filesystem::create_directories(path.parent_path());
    base::write_file(path, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

}  // namespace

Command::Command(const std::string& summary, const std::string& name) : App(summary, name) {
    set_help_flag("-h,--help", "Print this help.")->group("General");
    formatter_fn([](const CLI::App* app, const std::string&, CLI::AppFormatMode) {
        return help_text(dynamic_cast<const Command&>(*app));
    });
}

bool takes_value(const CLI::Option& option) { return option.get_expected_min() > 0; }

bool is_shown(const CLI::Option& option) { return !option.get_group().empty(); }

std::vector<const Command*> commands_of(const Command& program) {
    std::vector<const Command*> commands;
    for (const CLI::App* each : program.get_subcommands([](const CLI::App*) { return true; }))
        commands.push_back(&dynamic_cast<const Command&>(*each));
    return commands;
}

std::string help_text(const Command& command) {
    constexpr std::size_t kTerms = 28, kExamples = 6;  // columns at which texts begin
    const Page page = page_of(command);
    std::string text = "Usage: " + page.usage + "\n\n" + wrapped(page.summary, 0);
    for (const std::string& paragraph : page.description) text += "\n" + wrapped(paragraph, 0);
    for (const Section& section : page.options) text += help_section(section, kTerms);
    return text + help_section(page.environment, kTerms) + help_section(page.exit_statuses, kTerms) +
           help_section(page.examples, kExamples);
}

std::string manual_page(const Command& command, const std::string& version) {
    const Page page = page_of(command);
    // The line NAME is a fragment, as whatis(1) shows it.
    std::string what = page.summary.substr(0, page.summary.size() - 1);
    what[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(what[0])));
    std::string text = ".TH " + escaped(upper(page_name(command))) + " 1 \"\" \"vrut\\-preview " + version +
                       "\" \"User Commands\"\n.SH NAME\n" + escaped(page_name(command)) + " \\- " +
                       escaped(what) + "\n.SH SYNOPSIS\n" + highlighted(page.usage) + "\n.SH DESCRIPTION\n" +
                       escaped(page.summary) + "\n";
    for (const std::string& paragraph : page.description) text += ".PP\n" + escaped(paragraph) + "\n";
    text += ".SH OPTIONS\n";
    for (const Section& section : page.options)
        text += ".SS " + section.title + "\n" + roff_entries(section.entries);
    return text + roff_section(page.environment) + roff_section(page.exit_statuses) +
           roff_section(page.examples) + see_also(command);
}

void write_manual(const Command& program, const std::string& version, const std::filesystem::path& folder) {
    std::vector<const Command*> commands = commands_of(program);
    commands.push_back(&program);
    for (const Command* command : commands)
        write_text(folder / "man1" / (page_name(*command) + ".1"), manual_page(*command, version));
    write_text(folder / "completions" / program.get_name(), bash_completion(program));
}

}  // namespace vrut::server::commands
