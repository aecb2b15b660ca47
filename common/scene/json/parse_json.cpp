// This is the only file that uses nlohmann/json for scenes. It converts SAX events to a tree of JsonNode.
#include "common/scene/json/json_reader.h"
#include "common/system/error.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <unordered_set>

namespace duet {

namespace {

/// Returns the line and column, both from 1, of the byte at an offset.
std::string line_and_column(std::string_view text, std::size_t offset) {
    const std::string_view before = text.substr(0, std::min(offset, text.size()));
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    const std::size_t start = before.rfind('\n');
    const std::size_t column = start == std::string_view::npos ? before.size() + 1 : before.size() - start;
    return message("line ", line, ", column ", column);
}

/// Returns at most 200 bytes of the text, on one line. Bytes that are not printable ASCII become "?".
std::string printable(std::string text) {
    for (char& c : text)
        if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) >= 0x7f) c = '?';
    return text.size() > 200 ? text.substr(0, 200) + " …" : text;
}

/// Removes the prefix of nlohmann's messages. Of "[json.exception.parse_error.101] parse error at line 1, column 2:
/// syntax error while …" it keeps the text from "syntax" on.
std::string reason(const std::string& what) {
    std::string text = what;
    const std::size_t bracket = text.find("] ");
    if (text.starts_with("[json") && bracket != std::string::npos) text.erase(0, bracket + 2);
    const std::size_t colon = text.find(": ");
    if (text.starts_with("parse error at") && colon != std::string::npos) text.erase(0, colon + 2);
    return printable(text);
}

class TreeBuilder : public nlohmann::json_sax<nlohmann::json> {
public:
    TreeBuilder(const std::filesystem::path& file, std::string_view text) : file_(file), text_(text) {}
    JsonNode take() { return std::move(root_); }

    bool null() override { return add({}); }
    bool boolean(bool value) override { return add({.kind = JsonNode::Kind::kBoolean, .boolean = value}); }
    bool number_integer(number_integer_t value) override { return add_number(static_cast<double>(value)); }
    bool number_unsigned(number_unsigned_t value) override { return add_number(static_cast<double>(value)); }
    bool number_float(number_float_t value, const string_t&) override { return add_number(value); }
    bool string(string_t& value) override { return add({.kind = JsonNode::Kind::kString, .text = std::move(value)}); }
    bool binary(binary_t&) override { return false; }
    bool start_object(std::size_t) override { return open(JsonNode::Kind::kObject); }
    bool start_array(std::size_t) override { return open(JsonNode::Kind::kArray); }
    bool end_object() override { return close(); }
    bool end_array() override { return close(); }
    bool key(string_t& value) override {
        if (!keys_.back().insert(value).second)
            throw Error(message(file_.string(), ": ", path(), ": the key ", quoted_text(value), " is given twice"));
        open_.back()->keys.push_back(std::move(value));
        return true;
    }
    bool parse_error(std::size_t position, const std::string&, const nlohmann::json::exception& error) override {
        throw Error(message(file_.string(), ": ", line_and_column(text_, position > 0 ? position - 1 : 0), ": ",
                            reason(error.what())));
    }

private:
    /// Returns the JSON path of the innermost open value.
    std::string path() const {
        std::string text = "$";
        for (std::size_t i = 0; i + 1 < open_.size(); ++i)
            text += open_[i]->kind == JsonNode::Kind::kObject ? "." + open_[i]->keys.back()
                                                              : message("[", open_[i]->items.size() - 1, "]");
        return printable(text);
    }
    bool add_number(double value) { return add({.kind = JsonNode::Kind::kNumber, .number = value}); }
    /// Adds the value to the innermost open node. The pointers in open_ stay valid, because only that node grows.
    bool add(JsonNode&& node) {
        last_ = open_.empty() ? &(root_ = std::move(node)) : &open_.back()->items.emplace_back(std::move(node));
        return true;
    }
    bool open(JsonNode::Kind kind) {
        if (open_.size() >= kMaxJsonDepth)
            throw Error(message(file_.string(), ": values are nested more than ", kMaxJsonDepth, " deep"));
        add({.kind = kind});
        open_.push_back(last_);
        keys_.emplace_back();
        return true;
    }
    bool close() {
        open_.pop_back();
        keys_.pop_back();
        return true;
    }

    const std::filesystem::path& file_;
    std::string_view text_;
    JsonNode root_;
    JsonNode* last_ = nullptr;
    std::vector<JsonNode*> open_;
    std::vector<std::unordered_set<std::string>> keys_; ///< keys read so far, for each open value
};

} // namespace

JsonNode parse_json(const std::filesystem::path& file, std::string_view text) {
    TreeBuilder builder(file, text);
    nlohmann::json::sax_parse(text.begin(), text.end(), &builder);
    return builder.take();
}

} // namespace duet
