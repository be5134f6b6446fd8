// SPDX-License-Identifier: MIT
//
// JSON text to documents and back, with nlohmann's ordered_json.
//
// The text is read through the library's SAX interface, for three reasons: nesting can be capped before
// a recursive destructor meets it, duplicate keys are seen (the library's own DOM silently keeps one of
// them), and containers can be made with their final size. The last matters because an ordered_json object is
// a vector of pairs with a constant key: when such a vector grows, it copies its members with all their
// descendants. Members are therefore gathered on a stack of our own and moved once; grow_object() of json.cpp
// does the same when a member is added later.
#include "ext/guard.hpp"
#include "ext/json_parts.hpp"

#include <algorithm>
#include <cstring>
#include <iomanip>
#include <limits>
#include <ostream>
#include <streambuf>
#include <string>
#include <vector>

namespace {

using json = nlohmann::ordered_json;

// ---- parsing ----

// A pointer that tells how far the lexer has come.
struct text_iterator {
	using difference_type = std::ptrdiff_t;
	using value_type = char;
	using pointer = const char *;
	using reference = const char &;
	using iterator_category = std::input_iterator_tag;

	const char *at;
	const char **reached;

	reference operator*() const
	{
		return *at;
	}
	text_iterator &operator++()
	{
		*reached = ++at;
		return *this;
	}
	bool operator==(const text_iterator &other) const
	{
		return at == other.at;
	}
	bool operator!=(const text_iterator &other) const
	{
		return at != other.at;
	}
};

struct member {
	std::string key;
	json value;
	size_t key_offset;
};

// Gathers the values of all open containers on one stack; a container's children are taken off when it ends.
class builder : public nlohmann::json_sax<json> {
public:
	builder(const char *text, const char *const *reached_, nt_error *error_)
	    : begin(text), reached(reached_), error(error_)
	{
	}

	json take()
	{
		return std::move(stack.back().value);
	}

	bool null() override
	{
		return push(json());
	}
	bool boolean(bool value) override
	{
		return push(json(value));
	}
	bool number_integer(number_integer_t value) override
	{
		return push(json(value));
	}
	bool number_unsigned(number_unsigned_t value) override
	{
		return push(json(value));
	}
	bool number_float(number_float_t value, const string_t &) override
	{
		return push(json(value));
	}
	bool string(string_t &value) override
	{
		return push(json(std::move(value)));
	}
	bool binary(binary_t &) override
	{
		return false; // not in texts
	}
	bool start_object(std::size_t) override
	{
		return open();
	}
	bool start_array(std::size_t) override
	{
		return open();
	}
	bool key(string_t &value) override
	{
		pending_key = std::move(value);
		pending_offset = offset();
		return true;
	}

	bool end_object() override
	{
		const size_t first = starts.back().first;
		if (!keys_are_unique(first))
			return false;
		json object = json::object();
		auto &members = object.get_ref<json::object_t &>();
		members.reserve(stack.size() - first);
		for (size_t i = first; i < stack.size(); i++)
			static_cast<json::object_t::Container &>(members).emplace_back(
				std::move(stack[i].key), std::move(stack[i].value));
		return close(std::move(object));
	}

	bool end_array() override
	{
		const size_t first = starts.back().first;
		json array = json::array();
		auto &elements = array.get_ref<json::array_t &>();
		elements.reserve(stack.size() - first);
		for (size_t i = first; i < stack.size(); i++)
			elements.push_back(std::move(stack[i].value));
		return close(std::move(array));
	}

	bool parse_error(std::size_t position, const std::string &,
		const nlohmann::detail::exception &thrown) override
	{
		// "[json.exception.parse_error.101] parse error at line 1, column 2: syntax error while ..."
		const char *words = thrown.what();
		if (const char *bracket = std::strstr(words, "] "))
			words = bracket + 2;
		if (const char *colon = std::strstr(words, ": "))
			words = std::strncmp(words, "parse error", 11) == 0 ? colon + 2 : words;
		nt_fail_offset(error, NT_ERROR_INPUT, position ? position - 1 : 0, "JSON: %s", words);
		return false;
	}

private:
	struct start {
		size_t first;
		std::string key;
		size_t key_offset;
	};

	size_t offset() const
	{
		return static_cast<size_t>(*reached - begin);
	}

	bool push(json value)
	{
		stack.push_back(member{std::move(pending_key), std::move(value), pending_offset});
		pending_key.clear();
		return true;
	}

	bool open()
	{
		if (starts.size() == NT_JSON_MAX_DEPTH) {
			nt_fail_offset(error, NT_ERROR_INPUT, offset() - 1,
				"JSON is nested deeper than %d arrays and objects", int(NT_JSON_MAX_DEPTH));
			return false;
		}
		starts.push_back(start{stack.size(), std::move(pending_key), pending_offset});
		pending_key.clear();
		return true;
	}

	bool close(json container)
	{
		stack.erase(stack.begin() + static_cast<std::ptrdiff_t>(starts.back().first), stack.end());
		pending_key = std::move(starts.back().key);
		pending_offset = starts.back().key_offset;
		starts.pop_back();
		return push(std::move(container));
	}

	// Small objects pair by pair, large ones through a sorted index.
	bool keys_are_unique(size_t first)
	{
		const size_t count = stack.size() - first;
		if (count <= 16) {
			for (size_t i = first; i < stack.size(); i++)
				for (size_t k = first; k < i; k++)
					if (stack[i].key == stack[k].key)
						return duplicate(stack[i]);
			return true;
		}
		std::vector<const member *> order(count);
		for (size_t i = 0; i < count; i++)
			order[i] = &stack[first + i];
		std::sort(order.begin(), order.end(), [](const member *a, const member *b) {
			const int difference = a->key.compare(b->key);
			return difference ? difference < 0 : a < b;
		});
		for (size_t i = 1; i < count; i++)
			if (order[i]->key == order[i - 1]->key)
				return duplicate(*order[i]);
		return true;
	}

	bool duplicate(const member &second)
	{
		nt_fail_offset(error, NT_ERROR_INPUT, second.key_offset,
			"JSON: the key \"%.200s\" occurs twice in one object", second.key.c_str());
		return false;
	}

	const char *begin;
	const char *const *reached;
	nt_error *error;
	std::vector<member> stack;
	std::vector<start> starts;
	std::string pending_key;
	size_t pending_offset = 0;
};

// The indentation of the first member tells the style of the whole.
void find_style(nt_json *document, const char *text, size_t size)
{
	const char *const end = text + size;
	const char *at = std::find(text, end, '{');
	if (at == end)
		return;
	++at;
	bool broken = false;
	int indent = 0;
	char character = ' ';
	for (; at != end && (*at == ' ' || *at == '\t' || *at == '\n' || *at == '\r'); ++at) {
		if (*at == '\n') {
			broken = true;
			indent = 0;
		} else if (*at != '\r') {
			character = *at;
			indent++;
		}
	}
	if (broken) {
		document->indent = std::min(indent, 16);
		document->indent_character = character;
	}
}

// ---- writing ----

// A stream into an nt_buffer: the library prints only to streams and to strings of its own. It prints character by
// character, so a block gathers them.
class buffer_stream : public std::streambuf {
public:
	explicit buffer_stream(nt_buffer *buffer_) : buffer(buffer_)
	{
		setp(block, block + sizeof block);
	}

protected:
	int_type overflow(int_type character) override
	{
		if (sync() != 0)
			return traits_type::eof();
		return traits_type::eq_int_type(character, traits_type::eof()) ? 0
			: sputc(traits_type::to_char_type(character));
	}
	int sync() override
	{
		nt_buffer_append(buffer, block, static_cast<size_t>(pptr() - pbase()));
		setp(block, block + sizeof block);
		return buffer->failed ? -1 : 0;
	}

private:
	nt_buffer *buffer;
	char block[4096];
};

} // namespace

nt_status nt_json_parse(nt_json **document, const char *text, size_t size, nt_error *error)
{
	*document = nullptr;
	nt_json *parsed = nullptr;
	const nt_status status = nt::guard(error, "JSON", [&] {
		if (size >= 3 && std::memcmp(text, "\xEF\xBB\xBF", 3) == 0)
			return nt_fail_offset(error, NT_ERROR_INPUT, 0,
				"JSON begins with a byte order mark, which glTF does not allow");
		const char *reached = text;
		builder sink(text, &reached, error);
		const text_iterator begin{text, &reached}, end{text + size, &reached};
		if (!json::sax_parse(begin, end, &sink))
			return NT_ERROR_INPUT;
		parsed = new nt_json;
		parsed->root = sink.take();
		find_style(parsed, text, size);
		return NT_OK;
	});
	if (status) {
		nt_json_free(parsed);
		return status;
	}
	*document = parsed;
	return NT_OK;
}

nt_status nt_json_dump(const nt_json *document, nt_buffer *text, nt_error *error)
{
	return nt::guard(error, "JSON", [&] {
		if (document->failed)
			return nt_fail_memory(error);
		buffer_stream stream(text);
		std::ostream out(&stream);
		if (document->indent > 0)
			out << std::setw(document->indent) << std::setfill(document->indent_character);
		out << document->root << std::flush;
		return text->failed ? nt_fail_memory(error) : NT_OK;
	});
}
