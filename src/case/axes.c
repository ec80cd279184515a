/* axes: how many numbers a case gives for its grid, looked up in its file before MPI begins; what is wrong with the
   file is said later, by its reader. */
#include "case_private.h"
#include <limits.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <yaml.h>

static FILE *Open(const char *given)
{
  struct stat what;
  char        path[PATH_MAX];

  CaseFile(given, path, sizeof path);
  return stat(path, &what) == 0 && S_ISREG(what.st_mode) ? fopen(path, "r") : NULL; /* a pipe can be read but once */
}

/* The events of a text one after the other; it ends where the text is wrong or nested more deeply than any grid is. */
#define DEEPEST 16
typedef struct {
  yaml_parser_t parser;
  yaml_event_t  event;
  int           depth, axes; /* axes: the least that any list of the grid has */
  bool          ended;
} Walk;

/* Kind of the next event. */
static yaml_event_type_t Next(Walk *w)
{
  if (w->ended)
    return YAML_STREAM_END_EVENT;
  yaml_event_delete(&w->event);
  w->ended = !yaml_parser_parse(&w->parser, &w->event) || w->event.type == YAML_STREAM_END_EVENT || w->depth > DEEPEST;
  return w->ended ? YAML_STREAM_END_EVENT : w->event.type;
}

static int Value(Walk *w, const char *path);

/* Values up to the end of a list. */
static int Items(Walk *w)
{
  int n = 0;

  while (Next(w) != YAML_SEQUENCE_END_EVENT && !w->ended) {
    (void)Value(w, "");
    n++;
  }
  return n;
}

/* Keys up to the end of a map; `path`: of the map itself. */
static void Map(Walk *w, const char *path)
{
  while (Next(w) != YAML_MAPPING_END_EVENT && !w->ended) {
    const bool  plain = w->event.type == YAML_SCALAR_EVENT;
    char        key[64];
    const char *name = plain ? (const char *)w->event.data.scalar.value : "";

    snprintf(key, sizeof key, "%s%s%.48s", path, *path ? "_" : "", name);
    if (!plain)
      (void)Value(w, "");
    (void)Next(w);
    const int  n = Value(w, key);
    const bool grid =
        !strcasecmp(key, "grid_lower") || !strcasecmp(key, "grid_upper") || !strcasecmp(key, "grid_cells");

    if (grid && n && (!w->axes || n < w->axes))
      w->axes = n;
  }
}

/* Of the event that was read last: how many values a list has, 0 for all else. */
static int Value(Walk *w, const char *path)
{
  int n = 0;

  w->depth++;
  if (w->event.type == YAML_SEQUENCE_START_EVENT && !w->ended)
    n = Items(w);
  if (w->event.type == YAML_MAPPING_START_EVENT && !w->ended)
    Map(w, path);
  w->depth--;
  return n;
}

int CaseAxes(const char *given)
{
  FILE *f = Open(given);
  Walk  w = {.axes = 0};

  if (!f)
    return 0;
  if (yaml_parser_initialize(&w.parser)) {
    yaml_parser_set_input_file(&w.parser, f);
    while (!w.ended && Next(&w) != YAML_MAPPING_START_EVENT)
      ;
    (void)Value(&w, "");
    yaml_event_delete(&w.event);
    yaml_parser_delete(&w.parser);
  }
  fclose(f);
  return w.axes;
}
