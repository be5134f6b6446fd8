// SPDX-License-Identifier: MIT
//
// nlohmann's ordered_json behind json.h: documents and their values. Text is in json_text.cpp.
//
// An ordered_json object is a vector of pairs with a constant key: when such a vector grows, it copies its members
// with all their descendants. So grow_object() moves them to a larger one instead.
#include "ext/json_parts.hpp"
#include "ext/reserve.hpp"

#include <cmath>
#include <cstring>
#include <limits>
#include <string>

namespace {

using json = nlohmann::ordered_json;

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

// Runs a change that returns the value to hand out; remembers what goes wrong.
template <typename Body> nt_json_value *change(nt_json *document, Body &&body) noexcept
{
	const nt::reserve memory;
	try {
		json *const value = body();
		document->failed |= memory.was_needed();
		return wrap(value);
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

void nt_json_free(nt_json *document)
{
	const nt::reserve memory;
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
	return change(document, [&] {
		json::object_t::Container &members = members_of(unwrap(object));
		if (json *found = find_member(members, key))
			return found;
		grow_object(members);
		members.emplace_back(std::string(key), json());
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

void nt_json_set_object(nt_json *document, nt_json_value *value)
{
	assign(document, value, [&] { return json(json::object()); });
}

void nt_json_set_copy(nt_json *document, nt_json_value *value, const nt_json_value *from)
{
	assign(document, value, [&] { return json(*unwrap(from)); });
}
