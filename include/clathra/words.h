/* words: numbers with the unit in which they read well, for what a run says. */
#pragma once

#include "clathra/dimension.h"

/* A few words, to be printed where they are made: TimeAt(t).s. */
typedef struct {
  char s[32];
} Words;
/* "12 s", "3.4 h", "1 year": a time (s) with so many digits, in the largest unit of which `scale` (s) holds two, or in
   its own below a hundredth of that ... */
Words TimeWordsAs(double seconds, double scale, int digits);
/* ... or a time (s) does itself. */
Words TimeWords(double seconds, int digits);
typedef struct {
  char s[64];
} Place;
/* "(3, 4) m": a place, m. */
Place PlaceWords(const double x[CL_DIM]);
/* A time of the scene (s). */
Words TimeAt(double t);
/* "4.1 MPa", "30 kPa", "12 Pa": a pressure or stress (Pa) with so many digits. */
Words PressureWords(double pascals, int digits);
/* "35", "140", "2.4e+11": a number of steps (dimensionless), from 100 on in two digits. */
Words CountWords(double n);
