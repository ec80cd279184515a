/* Times, pressures and counts in words. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include "clathra/words.h"

static void TestTimes(void **state)
{
  (void)state;
  assert_string_equal(TimeWords(0.25, 3).s, "0.25 s");
  assert_string_equal(TimeWords(90.0, 3).s, "90 s");
  assert_string_equal(TimeWords(150.0, 3).s, "2.5 min");
  assert_string_equal(TimeWords(3.0 * 86400.0, 3).s, "3 days");
  assert_string_equal(TimeWordsAs(86400.0, 3.0 * 86400.0, 3).s, "1 day");
  assert_string_equal(TimeWordsAs(3.15576e7, 1e9, 3).s, "1 year");
  assert_string_equal(TimeWordsAs(600.0, 1e9, 3).s, "10 min");
  assert_string_equal(TimeWordsAs(0.0, 1e9, 3).s, "0 years");
  assert_string_equal(TimeWordsAs(-7200.0, 1e9, 3).s, "-2 h");
  assert_string_equal(TimeAt(1.5 * 3.15576e9).s, "150 years");
}

static void TestPressures(void **state)
{
  (void)state;
  assert_string_equal(PressureWords(0.0, 3).s, "0 Pa");
  assert_string_equal(PressureWords(-12.0, 3).s, "-12 Pa");
  assert_string_equal(PressureWords(101325.0, 4).s, "101.3 kPa");
  assert_string_equal(PressureWords(999400.0, 3).s, "999 kPa");
  assert_string_equal(PressureWords(999900.0, 3).s, "1 MPa");
  assert_string_equal(PressureWords(-3.963871e6, 6).s, "-3.96387 MPa");
  assert_string_equal(PressureWords(2.2e9, 3).s, "2.2 GPa");
}

static void TestCounts(void **state)
{
  (void)state;
  assert_string_equal(CountWords(0.4).s, "0");
  assert_string_equal(CountWords(35.4).s, "35");
  assert_string_equal(CountWords(99.6).s, "100");
  assert_string_equal(CountWords(144.0).s, "140");
  assert_string_equal(CountWords(98765.0).s, "99000");
  assert_string_equal(CountWords(2.44e11).s, "2.4e+11");
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(TestTimes), cmocka_unit_test(TestPressures),
                                     cmocka_unit_test(TestCounts)};

  return cmocka_run_group_tests(tests, NULL, NULL);
}
