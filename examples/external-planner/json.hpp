// A minimal reader of JSON, enough for the requests of the harness. Use a library in a real planner.

#pragma once

#include <cstdlib>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

class Json {
public:
    static Json parse(const std::string& text) {
        const char* at = text.c_str();
        return value(at);
    }

    double number() const { return number_; }
    const std::string& text() const { return text_; }
    const std::vector<Json>& items() const { return items_; }
    const Json& operator[](int index) const { return items_.at(static_cast<size_t>(index)); }
    const Json& operator[](const char* key) const { return members_.at(key); }

private:
    double number_ = 0;  // also true (1), false and null (0)
    std::string text_;
    std::vector<Json> items_;
    std::map<std::string, Json> members_;

    static void skip_space(const char*& at) {
        while (*at == ' ' || *at == '\t' || *at == '\n' || *at == '\r') ++at;
    }

    static void expect(const char*& at, char wanted) {
        skip_space(at);
        if (*at++ != wanted) throw std::runtime_error(std::string("JSON: expected ") + wanted);
    }

    // Is the list over? Skips the comma if not.
    static bool ends(const char*& at, char closing, bool is_first) {
        skip_space(at);
        if (*at == closing) return ++at, true;
        if (!is_first) expect(at, ',');
        return false;
    }

    static std::string quoted(const char*& at) {
        std::string text;
        for (expect(at, '"'); *at != '"'; ++at) {
            if (*at == '\0') throw std::runtime_error("JSON: text without an end");
            if (*at == '\\') ++at;  // \uXXXX is kept as it is: names in requests are plain
            text += *at;
        }
        return ++at, text;
    }

    static Json word(const char*& at) {
        Json json;
        json.number_ = *at == 't';
        while (*at >= 'a' && *at <= 'z') ++at;
        return json;
    }

    static Json value(const char*& at) {
        Json json;
        skip_space(at);
        if (*at == '{') {
            ++at;
            for (bool first = true; !ends(at, '}', first); first = false) {
                std::string key = quoted(at);
                expect(at, ':');
                json.members_[std::move(key)] = value(at);
            }
        } else if (*at == '[') {
            ++at;
            for (bool first = true; !ends(at, ']', first); first = false) json.items_.push_back(value(at));
        } else if (*at == '"') {
            json.text_ = quoted(at);
        } else if (*at >= 'a' && *at <= 'z') {
            return word(at);
        } else {
            char* end = nullptr;
            json.number_ = std::strtod(at, &end);
            if (end == at) throw std::runtime_error("JSON: expected a value");
            at = end;
        }
        return json;
    }
};
