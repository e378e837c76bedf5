/* The strict JSON reading in front of the importer: values, escapes, limits. JSONTestSuite is in test_import_hostile. */
#include "harness/harness.h"

#include <stdio.h>
#include <string.h>

#include "compile/json.h"

static EnfJson parse_ok(const char *text) {
    EnfJson json;
    EnfError error = {0};
    if (enf_json_parse(&json, text, strlen(text), 0, &error) != ENF_OK) {
        fail_msg("%s: %s", text, error.message);
    }
    return json;
}

static void members_are_found(void **state) {
    (void)state;
    EnfJson json = parse_ok(" {\"a\":[1,{\"b\":2}],\"\\u0062\":{\"a\":3},\"a\\u0000\":4,\"c\":5,\"c\":6} ");
    uint32_t a = enf_json_member(&json, 0, "a"), b = enf_json_member(&json, 0, "b");
    uint64_t value;
    assert_int_equal(json.values[0].count, 5);
    assert_int_equal(json.values[a].type, ENF_JSON_ARRAY);
    assert_int_equal(json.values[a].count, 2);
    assert_int_equal(json.values[b].type, ENF_JSON_OBJECT);
    assert_true(enf_json_uint(&json, enf_json_member(&json, b, "a"), 9, &value) && value == 3);
    assert_true(enf_json_uint(&json, enf_json_member(&json, 0, "c"), 9, &value) && value == 6); /* the last */
    assert_int_equal(enf_json_member(&json, 0, "d"), ENF_NONE);
    assert_int_equal(enf_json_member(&json, a, "b"), ENF_NONE);
    assert_int_equal(enf_json_member(&json, ENF_NONE, "b"), ENF_NONE);
    enf_json_free(&json);
}

static void strings_are_decoded(void **state) {
    (void)state;
    EnfJson json = parse_ok("\"\\\"\\\\\\/\\b\\f\\n\\r\\t\\u00e9\\u20AC\\uD834\\uDd1e\xC3\xA9\"");
    char text[64];
    size_t length = enf_json_string(&json, 0, text, sizeof text);
    assert_string_equal(text, "\"\\/\b\f\n\r\t\xC3\xA9\xE2\x82\xAC\xF0\x9D\x84\x9E\xC3\xA9");
    assert_int_equal(length, strlen(text));
    assert_int_equal(enf_json_string(&json, 0, text, length), SIZE_MAX);
    assert_int_equal(enf_json_string(&json, 0, text, length + 1), length);
    enf_json_free(&json);
}

static void numbers_are_judged(void **state) {
    (void)state;
    static const struct {
        const char *text;
        bool finite, whole;
    } cases[] = {{"0", true, true},           {"-0", true, false},      {"2147483647", true, true},
                 {"2147483648", true, false}, {"1.0", true, false},     {"1e2", true, false},
                 {"1e400", false, false},     {"-1e-400", true, false}, {"99999999999999999999", true, false},
                 {"\"1\"", false, false},     {"true", false, false}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        EnfJson json = parse_ok(cases[i].text);
        double number;
        uint64_t whole;
        assert_int_equal(enf_json_number(&json, 0, &number), cases[i].finite);
        assert_int_equal(enf_json_uint(&json, 0, INT32_MAX, &whole), cases[i].whole);
        enf_json_free(&json);
    }
}

static void errors_name_their_byte(void **state) {
    (void)state;
    static const struct {
        const char *text;
        uint64_t offset;
    } cases[] = {{"", 0},           {"[1,]", 3},      {"{\"a\" 1}", 5}, {"[1 2]", 3},
                 {"[\"\x01\"]", 2}, {"[\"\\x\"]", 3}, {"[01]", 3},      {"[1.]", 3},
                 {"nul", 0},        {"[] []", 3},     {"[\"a", 3},      {"[\"\\uD800\"]", 3},
                 {"{\"a\":1,}", 7}, {"[-]", 2},       {"{1:2}", 1},     {"[\"\xC0\x80\"]", 2}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        EnfJson json;
        EnfError error = {0};
        assert_int_equal(enf_json_parse(&json, cases[i].text, strlen(cases[i].text), 100, &error), ENF_ERROR_FORMAT);
        if (error.offset != 100 + cases[i].offset) {
            fail_msg("%s: byte %d, not %d", cases[i].text, (int)error.offset - 100, (int)cases[i].offset);
        }
        assert_null(json.values);
    }
}

static void spans_are_compacted(void **state) {
    (void)state;
    static const char text[] = "{ \"a b\" : [ 1.50 ,\t\"x \\\" \\\\\" ] ,\n\"c\":null }";
    EnfJson json = parse_ok(text);
    char compact[sizeof text];
    enf_json_compact(&json, 0, compact);
    assert_string_equal(compact, "{\"a b\":[1.50,\"x \\\" \\\\\"],\"c\":null}");
    enf_json_free(&json);
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test(members_are_found),      cmocka_unit_test(strings_are_decoded), cmocka_unit_test(numbers_are_judged),
    cmocka_unit_test(errors_name_their_byte), cmocka_unit_test(spans_are_compacted),
};

ENF_TEST_MAIN(tests)
