// SPDX-License-Identifier: MIT
//
// nlohmann's ordered_json behind json.h.
//
// The text is read through the library's SAX interface, for three reasons: nesting can be capped before
// a recursive destructor meets it, duplicate keys are seen (the library's own DOM silently keeps one of
// them), and containers can be made with their final size. The last matters because an ordered_json object is
// a vector of pairs with a constant key: when such a vector grows, it copies its members with all their
// descendants. Members are therefore gathered on a stack of our own and moved once, and grow_object()
// does the same when a member is added later.
#include "ext/json.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iomanip>
#include <limits>
#include <nlohmann/json.hpp>
#include <ostream>
#include <streambuf>
#include <string>
#include <vector>
#include "ext/guard.hpp"

using json = nlohmann::ordered_json;

struct nt_json {
	json root = json::object();
	json scratch; // what changing functions hand out once memory is exhausted
	int indent = -1;
	char indent_character = ' ';
	bool failed = false;
};

namespace {

json *unwrap(nt_json_value *value)
{
	return reinterpret_cast<json *>(value);
}

const json *unwrap(const nt_json_value *value)
{
	return reinterpret_cast<const json *>(value);
}

nt_json_value *wrap(const json *value)
{
	return reinterpret_cast<nt_json_value *>(const_cast<json *>(value));
}

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
		nt_fail_offset(error, NMTAN_ERROR_INPUT, position ? position - 1 : 0, "JSON: %s", words);
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
			nt_fail_offset(error, NMTAN_ERROR_INPUT, offset() - 1,
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
		nt_fail_offset(error, NMTAN_ERROR_INPUT, second.key_offset,
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

// ---- changing ----

// Runs a change that returns the value to hand out; remembers what goes wrong.
template <typename Body> nt_json_value *change(nt_json *document, Body &&body) noexcept
{
	try {
		return wrap(body());
	} catch (...) {
		document->failed = true;
		return wrap(&document->scratch);
	}
}

json::object_t::Container &members_of(json *object)
{
	if (!object->is_object())
		*object = json::object();
	return object->get_ref<json::object_t &>();
}

// Measures the key once: most members are told apart by their lengths.
template <typename Members> auto find_member(Members &members, const char *key) -> decltype(&members[0].second)
{
	const size_t length = std::strlen(key);
	for (auto &entry : members)
		if (entry.first.size() == length && std::memcmp(entry.first.data(), key, length) == 0)
			return &entry.second;
	return nullptr;
}

// Room for one more member, without copying descendants.
void grow_object(json::object_t::Container &members)
{
	if (members.size() < members.capacity())
		return;
	json::object_t::Container grown;
	grown.reserve(members.size() * 2 + 2);
	for (auto &entry : members)
		grown.emplace_back(entry.first, std::move(entry.second));
	members.swap(grown);
}

bool whole_number(const json *value, double *number)
{
	if (!value || !value->is_number_float())
		return false;
	*number = value->get<double>();
	return std::floor(*number) == *number;
}

} // namespace

// ---- documents ----

nmtan_status nt_json_parse(nt_json **document, const char *text, size_t size, nt_error *error)
{
	*document = nullptr;
	nt_json *parsed = nullptr;
	const nmtan_status status = nt::guard(error, "JSON", [&] {
		if (size >= 3 && std::memcmp(text, "\xEF\xBB\xBF", 3) == 0)
			return nt_fail_offset(error, NMTAN_ERROR_INPUT, 0,
				"JSON begins with a byte order mark, which glTF does not allow");
		const char *reached = text;
		builder sink(text, &reached, error);
		const text_iterator begin{text, &reached}, end{text + size, &reached};
		if (!json::sax_parse(begin, end, &sink))
			return NMTAN_ERROR_INPUT;
		parsed = new nt_json;
		parsed->root = sink.take();
		find_style(parsed, text, size);
		return NMTAN_OK;
	});
	if (status) {
		delete parsed;
		return status;
	}
	*document = parsed;
	return NMTAN_OK;
}

nt_json *nt_json_create(void)
{
	try {
		return new nt_json;
	} catch (...) {
		return nullptr;
	}
}

void nt_json_free(nt_json *document)
{
	delete document;
}

nt_json_value *nt_json_root(nt_json *document)
{
	return wrap(&document->root);
}

bool nt_json_failed(const nt_json *document)
{
	return document->failed;
}

nmtan_status nt_json_dump(const nt_json *document, nt_buffer *text, nt_error *error)
{
	return nt::guard(error, "JSON", [&] {
		if (document->failed)
			return nt_fail_memory(error);
		buffer_stream stream(text);
		std::ostream out(&stream);
		if (document->indent > 0)
			out << std::setw(document->indent) << std::setfill(document->indent_character);
		out << document->root << std::flush;
		return text->failed ? nt_fail_memory(error) : NMTAN_OK;
	});
}

// ---- reading ----

nt_json_type nt_json_type_of(const nt_json_value *value)
{
	if (!value)
		return NT_JSON_NONE;
	switch (unwrap(value)->type()) {
	case json::value_t::boolean:
		return NT_JSON_BOOLEAN;
	case json::value_t::number_integer:
	case json::value_t::number_unsigned:
		return NT_JSON_INTEGER;
	case json::value_t::number_float:
		return NT_JSON_REAL;
	case json::value_t::string:
		return NT_JSON_STRING;
	case json::value_t::array:
		return NT_JSON_ARRAY;
	case json::value_t::object:
		return NT_JSON_OBJECT;
	default:
		return NT_JSON_NULL;
	}
}

const char *nt_json_type_text(const nt_json_value *value)
{
	static const char *const texts[] = {"nothing", "null", "a boolean", "an integer", "a number",
		"a string", "an array", "an object"};
	return texts[nt_json_type_of(value)];
}

size_t nt_json_count(const nt_json_value *value)
{
	if (!value || !unwrap(value)->is_structured())
		return 0;
	return unwrap(value)->size();
}

nt_json_value *nt_json_at(const nt_json_value *value, size_t index)
{
	if (index >= nt_json_count(value))
		return nullptr;
	const json *container = unwrap(value);
	if (container->is_array())
		return wrap(&container->get_ref<const json::array_t &>()[index]);
	const json::object_t::Container &members = container->get_ref<const json::object_t &>();
	return wrap(&members[index].second);
}

const char *nt_json_key(const nt_json_value *object, size_t index, size_t *length)
{
	if (index >= nt_json_count(object) || !unwrap(object)->is_object())
		return nullptr;
	const json::object_t::Container &members = unwrap(object)->get_ref<const json::object_t &>();
	const std::string &key = members[index].first;
	if (length)
		*length = key.size();
	return key.c_str();
}

nt_json_value *nt_json_find(const nt_json_value *object, const char *key)
{
	if (!object || !unwrap(object)->is_object())
		return nullptr;
	const json::object_t::Container &members = unwrap(object)->get_ref<const json::object_t &>();
	return wrap(find_member(members, key));
}

bool nt_json_get_bool(const nt_json_value *value, bool *result)
{
	if (!value || !unwrap(value)->is_boolean())
		return false;
	*result = unwrap(value)->get<bool>();
	return true;
}

bool nt_json_get_int64(const nt_json_value *value, int64_t *result)
{
	const json *number = unwrap(value);
	double real;
	if (whole_number(number, &real)) {
		if (!(real >= -0x1p63 && real < 0x1p63))
			return false;
		*result = static_cast<int64_t>(real);
		return true;
	}
	if (!number || !number->is_number_integer())
		return false;
	if (number->is_number_unsigned() &&
		number->get<uint64_t>() > uint64_t(std::numeric_limits<int64_t>::max()))
		return false;
	*result = number->get<int64_t>();
	return true;
}

bool nt_json_get_uint64(const nt_json_value *value, uint64_t *result)
{
	const json *number = unwrap(value);
	double real;
	if (whole_number(number, &real)) {
		if (!(real >= 0 && real < 0x1p64))
			return false;
		*result = static_cast<uint64_t>(real);
		return true;
	}
	if (!number || !number->is_number_integer())
		return false;
	if (!number->is_number_unsigned() && number->get<int64_t>() < 0)
		return false;
	*result = number->get<uint64_t>();
	return true;
}

bool nt_json_get_double(const nt_json_value *value, double *result)
{
	if (!value || !unwrap(value)->is_number())
		return false;
	*result = unwrap(value)->get<double>();
	return true;
}

const char *nt_json_get_string(const nt_json_value *value, size_t *length)
{
	if (!value || !unwrap(value)->is_string())
		return nullptr;
	const std::string &text = unwrap(value)->get_ref<const std::string &>();
	if (length)
		*length = text.size();
	return text.c_str();
}

bool nt_json_equal(const nt_json_value *a, const nt_json_value *b)
{
	if (!a || !b)
		return a == b;
	return *unwrap(a) == *unwrap(b);
}

// ---- changing ----

nt_json_value *nt_json_put(nt_json *document, nt_json_value *object, const char *key)
{
	return nt_json_insert(document, object, SIZE_MAX, key);
}

nt_json_value *nt_json_insert(nt_json *document, nt_json_value *object, size_t index, const char *key)
{
	return change(document, [&] {
		json::object_t::Container &members = members_of(unwrap(object));
		if (json *found = find_member(members, key))
			return found;
		grow_object(members);
		members.emplace_back(std::string(key), json());
		// Members cannot be assigned (their keys are constant): those behind `index` are made anew.
		if (index < members.size() - 1) {
			json::object_t::Container ordered;
			ordered.reserve(members.capacity());
			for (size_t i = 0; i < members.size(); i++) {
				if (i == index)
					ordered.emplace_back(members.back().first, json());
				if (i + 1 < members.size())
					ordered.emplace_back(members[i].first, std::move(members[i].second));
			}
			members.swap(ordered);
			return &members[index].second;
		}
		return &members.back().second;
	});
}

nt_json_value *nt_json_append(nt_json *document, nt_json_value *array)
{
	return change(document, [&] {
		if (!unwrap(array)->is_array())
			*unwrap(array) = json::array();
		auto &elements = unwrap(array)->get_ref<json::array_t &>();
		elements.emplace_back();
		return &elements.back();
	});
}

void nt_json_remove(nt_json *document, nt_json_value *object, const char *key)
{
	for (size_t i = 0; i < nt_json_count(object); i++) {
		const char *name = nt_json_key(object, i, nullptr);
		if (name && std::strcmp(name, key) == 0) {
			nt_json_remove_at(document, object, i);
			return;
		}
	}
}

void nt_json_remove_at(nt_json *document, nt_json_value *container, size_t index)
{
	if (index >= nt_json_count(container))
		return;
	(void)change(document, [&]() -> json * {
		json *from = unwrap(container);
		if (from->is_array()) {
			auto &elements = from->get_ref<json::array_t &>();
			elements.erase(elements.begin() + static_cast<std::ptrdiff_t>(index));
			return from;
		}
		json::object_t::Container &members = from->get_ref<json::object_t &>();
		json::object_t::Container kept;
		kept.reserve(members.size());
		for (size_t i = 0; i < members.size(); i++)
			if (i != index)
				kept.emplace_back(members[i].first, std::move(members[i].second));
		members.swap(kept);
		return from;
	});
}

namespace {

template <typename Content>
void assign(nt_json *document, nt_json_value *value, Content &&content) noexcept
{
	(void)change(document, [&] {
		*unwrap(value) = content();
		return unwrap(value);
	});
}

} // namespace

void nt_json_set_bool(nt_json *document, nt_json_value *value, bool content)
{
	assign(document, value, [&] { return json(content); });
}

void nt_json_set_uint64(nt_json *document, nt_json_value *value, uint64_t content)
{
	assign(document, value, [&] { return json(content); });
}

void nt_json_set_double(nt_json *document, nt_json_value *value, double content)
{
	assign(document, value, [&] { return json(content); });
}

void nt_json_set_string(nt_json *document, nt_json_value *value, const char *text, size_t length)
{
	assign(document, value, [&] { return json(std::string(text, length)); });
}

void nt_json_set_array(nt_json *document, nt_json_value *value)
{
	assign(document, value, [&] { return json(json::array()); });
}

void nt_json_set_object(nt_json *document, nt_json_value *value)
{
	assign(document, value, [&] { return json(json::object()); });
}

void nt_json_set_copy(nt_json *document, nt_json_value *value, const nt_json_value *from)
{
	assign(document, value, [&] { return json(*unwrap(from)); });
}
