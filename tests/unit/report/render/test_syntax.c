/* SPDX-License-Identifier: MIT */
/*
 * Texts as formats write them, by the formats' own rules, and templates.
 */
#include "test.h"

#include <inttypes.h>
#include <math.h>
#include "report/render/render.h"

static void expect(nt_buffer *out, const char *wanted)
{
	assert_false(out->failed);
	assert_string_equal(out->data ? out->data : "", wanted);
	nt_buffer_free(out);
}

TEST(each_syntax_escapes_what_it_reserves)
{
	/* quotes, markup, control characters, a line end, UTF-8 of two bytes, a byte that is none, a mark that turns
	 * text */
	static const char text[] = "=\"a\\'<&>|*\x01\x7f\t\n\xc3\xbc\xff\xe2\x80\xae%,:";
	static const struct {
		nt_syntax syntax;
		const char *wanted;
	} rows[] = {
		{NT_PLAIN, "=\"a\\'<&>|*\x01\x7f\t\n\xc3\xbc\xff\xe2\x80\xae%,:"},
		{NT_TERMINAL, "=\"a\\'<&>|*\\x01\\x7f\\x09\\x0a\xc3\xbc\\xff\\xe2\\x80\\xae%,:"},
		{NT_JSON, "\"=\\\"a\\\\'<&>|*\\u0001\\u007f\\u0009\\n\xc3\xbc\\ufffd\xe2\x80\xae%,:\""},
		{NT_SCRIPT, "\"=\\\"a\\\\'\\u003c&>|*\\u0001\\u007f\\u0009\\n\xc3\xbc\\ufffd\xe2\x80\xae%,:\""},
		{NT_XML, "=&quot;a\\&#39;&lt;&amp;&gt;|*\xef\xbf\xbd\xef\xbf\xbd\t\n"
			"\xc3\xbc\xef\xbf\xbd\xef\xbf\xbd%,:"},
		{NT_MARKDOWN, "=\"a\\\\'&lt;&amp;\\>\\|\\*    \xc3\xbc\xef\xbf\xbd\xef\xbf\xbd%,:"},
		{NT_CSV, "\"'=\"\"a\\'<&>|*\\x01\\x7f\\x09\\x0a\xc3\xbc\\xff\\xe2\\x80\\xae%,:\""},
		{NT_URI, "%3D%22a%5C%27%3C%26%3E%7C%2A%01%7F%09%0A%C3%BC%FF%E2%80%AE%25%2C%3A"},
		{NT_COMMAND, "=\"a\\'<&>|*\\x01\\x7f\\x09%0A\xc3\xbc\\xff\\xe2\\x80\\xae%25,:"},
		{NT_PROPERTY, "=\"a\\'<&>|*\\x01\\x7f\\x09%0A\xc3\xbc\\xff\\xe2\\x80\\xae%25%2C%3A"},
	};
	for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
		nt_buffer out = {0};
		nt_put_text(&out, rows[i].syntax, text);
		expect(&out, rows[i].wanted);
	}
}

TEST(templates_of_json_have_null_for_what_is_unknown)
{
	const char *volatile none = NULL;
	nt_buffer out = {0};
	nt_put(&out, NT_JSON, "{'a':[");
	for (unsigned i = 0; i < 2; i++)
		nt_put(&out, NT_JSON, ", %u", i);
	nt_put(&out, NT_JSON, "],'b':%s,'c':%s,'d':%-s,'e':%u,'f':%" PRIu64 ",'g':%hhd,'h':%hhd", "x\"", none, "[]",
		UINT32_MAX, UINT64_MAX, true, false);
	nt_put(&out, NT_JSON, ",'i':[%g,%g,%g,%g,%.3g,%.2f],'j':%.0zu,'k':%.0zu,'l':%zu,'m':%d", (double)0.1f, -0.0,
		(double)NAN, (double)INFINITY, 1234.5, 0.5, (size_t)0, (size_t)7, (size_t)0, -3);
	nt_put(&out, NT_JSON, ",'n':%" PRIx64 ",'o':%" PRIx64 ",'p':%zu}", UINT64_C(0xab), UINT64_C(0),
		(size_t)UINT32_MAX);
	expect(&out, "{\"a\":[0, 1],\"b\":\"x\\\"\",\"c\":null,\"d\":[],\"e\":null,\"f\":null,\"g\":true,\"h\":false,"
		"\"i\":[0.100000001,0,null,null,1.23e+03,0.50],\"j\":null,\"k\":7,\"l\":0,\"m\":-3,"
		"\"n\":\"00000000000000ab\",\"o\":null,\"p\":4294967295}");
}

TEST(templates_of_others_escape_texts_alone)
{
	nt_buffer out = {0};
	nt_put(&out, NT_XML, "<a b='%s'>%-s%%</a>", "<'>", "<br/>");
	expect(&out, "<a b=\"&lt;&#39;&gt;\"><br/>%</a>");
	nt_put(&out, NT_CSV, "%s,%.0zu,%016" PRIx64 ",%-4s|%u", "+1", (size_t)0, UINT64_C(1), "ab", UINT32_MAX);
	expect(&out, "\"'+1\",,0000000000000001,ab  |4294967295");
}

/* Nothing behind its end is read: addresses are checked under sanitizers, and here by what would be written. */
TEST(a_template_that_ends_in_a_conversion_ends_there)
{
	static const char templates[][8] = {"1 %\0%%%", "1 %-5l\0%", "1 %zh\0%%"};
	for (size_t i = 0; i < sizeof templates / sizeof *templates; i++) {
		nt_buffer out = {0};
		nt_put(&out, NT_TERMINAL, (const char *volatile){templates[i]});
		expect(&out, "1 ");
	}
}

TEST(a_text_that_was_not_allocated_fails_the_buffer)
{
	nt_buffer out = {0};
	nt_put(&out, NT_TERMINAL, "%p", (char *)NULL);
	assert_true(out.failed);
	nt_buffer_free(&out);
}
