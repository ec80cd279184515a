/* document: the text of a case as YAML, read by libyaml, to entries: the keys of nested maps joined by '_', each with
   its line and the text of its value.  A list [a, b] becomes "a,b", a list of lists [[a, b], [c, d]] "a; b,c; d".
   Anchors, aliases and merge keys (<<) are YAML's; what a map says itself wins over what it merges. */
#include "case_private.h"
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <yaml.h>

#define DEPTH_MAX 16
#define PATH_LENGTH 256
#define ENTRIES_MAX 4096 /* also against aliases of aliases */

typedef struct {
  Reader          *r;
  yaml_document_t *doc;
  char             path[PATH_LENGTH];
} Walk;

static PetscInt LineOf(const yaml_node_t *n)
{
  return (PetscInt)n->start_mark.line + 1;
}

static bool SayAt(Reader *r, PetscInt line, const char *what)
{
  char where[32];

  snprintf(where, sizeof where, "line %d", (int)line);
  ReaderError(r, where, NULL, "%s", what);
  return false;
}

/* ---------------------------------------------------------------- what libyaml does not like */
static bool TabIndents(const char *text, size_t line)
{
  for (; line && text; line--)
    text = (text = strchr(text, '\n')) ? text + 1 : NULL;
  if (!text)
    return false;
  text += strspn(text, " ");
  return *text == '\t';
}

static bool SayUnreadable(Reader *r, const yaml_parser_t *p, const char *text)
{
  const char *context = p->context ? p->context : "", *problem = p->problem ? p->problem : "no reason given";
  const char *opened = strstr(context, "quoted scalar") ? "quote" : strstr(context, "flow") ? "bracket" : NULL;
  const int   line   = (int)p->problem_mark.line + 1;
  char        what[CASE_WHY];

  if (p->error == YAML_READER_ERROR) {
    ReaderError(r, NULL, NULL, "is not a text file: %s, at byte %zu", problem, p->problem_offset);
    return false;
  }
  if (TabIndents(text, p->problem_mark.line))
    return SayAt(r, line, "is indented with a tab; YAML wants spaces");
  if (opened) {
    snprintf(what, sizeof what, "a %s is opened here and not closed as it should be (line %d: %s)", opened, line,
             problem);
    return SayAt(r, (PetscInt)p->context_mark.line + 1, what);
  }
  snprintf(what, sizeof what, "is not readable as YAML (%s%s%s)", problem, *context ? " " : "", context);
  return SayAt(r, line, what);
}

static void ParserStart(yaml_parser_t *p, const char *text)
{
  if (!yaml_parser_initialize(p))
    abort(); /* no memory */
  yaml_parser_set_input_string(p, (const unsigned char *)text, strlen(text));
}

/* A first pass over the events, which ends as soon as the text is nested too deeply or is more than one document. */
static bool EventsPass(Reader *r, const char *text)
{
  yaml_parser_t     p;
  yaml_event_t      e;
  yaml_event_type_t type;
  int               depth = 0, documents = 0;
  bool              ok = true;

  ParserStart(&p, text);
  do {
    if (!yaml_parser_parse(&p, &e)) {
      ok = SayUnreadable(r, &p, text);
      break;
    }
    type = e.type;
    if (type == YAML_MAPPING_START_EVENT || type == YAML_SEQUENCE_START_EVENT)
      depth++;
    if (type == YAML_MAPPING_END_EVENT || type == YAML_SEQUENCE_END_EVENT)
      depth--;
    if (depth > DEPTH_MAX)
      ok = SayAt(r, (PetscInt)e.start_mark.line + 1, "is nested too deeply");
    if (type == YAML_DOCUMENT_START_EVENT && documents++)
      ok = SayAt(r, (PetscInt)e.start_mark.line + 1, "a second document begins here; a case is one");
    yaml_event_delete(&e);
  } while (ok && type != YAML_STREAM_END_EVENT);
  yaml_parser_delete(&p);
  return ok;
}

/* ---------------------------------------------------------------- entries */
static Entry *EntryFind(const Reader *r, const char *name)
{
  for (PetscInt i = 0; i < r->nentry; i++)
    if (!strcasecmp(r->entry[i].name, name))
      return &r->entry[i];
  return NULL;
}

static bool EntryAdd(Reader *r, const char *name, PetscInt line)
{
  if (r->nentry == ENTRIES_MAX)
    return SayAt(r, line, "the file has too many keys");
  if (r->nentry % 64 == 0)
    r->entry = realloc(r->entry, (size_t)(r->nentry + 64) * sizeof *r->entry);
  r->entry[r->nentry++] = (Entry){.name = strdup(name), .line = line};
  return true;
}

static bool SayOfKey(const Walk *w, const char *what)
{
  ReaderError(w->r, w->path, NULL, "%s", what);
  return false;
}

/* Tags change what a value means; a line break would end a row of the files that a run writes.  NULL: nothing is wrong.
 */
static const char *Fault(const yaml_node_t *n)
{
  const char *plain[] = {
      [YAML_SCALAR_NODE] = YAML_STR_TAG, [YAML_SEQUENCE_NODE] = YAML_SEQ_TAG, [YAML_MAPPING_NODE] = YAML_MAP_TAG};

  if (strcmp((const char *)n->tag, plain[n->type]))
    return "tags (!) are not allowed in a case";
  for (size_t i = 0; n->type == YAML_SCALAR_NODE && i < n->data.scalar.length; i++)
    if (n->data.scalar.value[i] < 0x20 || n->data.scalar.value[i] == 0x7f)
      return "holds a line break or a control character; a value is one line of text";
  return NULL;
}

static void Append(char **text, const char *more)
{
  const size_t len = *text ? strlen(*text) : 0, add = strlen(more);

  *text = realloc(*text, len + add + 1);
  memcpy(*text + len, more, add + 1);
}

/* The items of a list, and of lists in it if this one is the outermost. */
static bool ListText(Walk *w, const yaml_node_t *list, bool inner, char **text)
{
  const yaml_node_item_t *first = list->data.sequence.items.start, *end = list->data.sequence.items.top;

  for (const yaml_node_item_t *item = first; item < end; item++) {
    const yaml_node_t *n = yaml_document_get_node(w->doc, *item);

    if (Fault(n))
      return SayOfKey(w, Fault(n));
    if (item > first)
      Append(text, inner ? "; " : ",");
    if (n->type == YAML_MAPPING_NODE)
      return SayOfKey(w, "a list holds values, not maps");
    if (n->type == YAML_SEQUENCE_NODE && inner)
      return SayOfKey(w, "its lists are nested too deeply; a list of points is [[x, y], [x, y], ...]");
    if (n->type == YAML_SEQUENCE_NODE) {
      if (!ListText(w, n, true, text))
        return false;
      continue;
    }
    if (strpbrk((const char *)n->data.scalar.value, inner ? ",;" : ","))
      return SayOfKey(w, "a value in its list holds a comma or semicolon, which separates values");
    Append(text, (const char *)n->data.scalar.value);
  }
  return true;
}

static bool WalkMap(Walk *w, const yaml_node_t *map, size_t parent, int depth, bool merged);

static bool IsNull(const yaml_node_t *n)
{
  const char *text = (const char *)n->data.scalar.value;

  return !*text ||
         (n->data.scalar.style == YAML_PLAIN_SCALAR_STYLE && (!strcmp(text, "~") || !strcasecmp(text, "null")));
}

/* The value of the key that ends w->path; an empty one is NULL. */
static bool WalkValue(Walk *w, const yaml_node_t *n, PetscInt line, int depth)
{
  const PetscInt i = w->r->nentry;

  if (!EntryAdd(w->r, w->path, line))
    return false;
  if (Fault(n))
    return SayOfKey(w, Fault(n));
  if (n->type == YAML_SEQUENCE_NODE)
    return ListText(w, n, false, &w->r->entry[i].value);
  if (n->type == YAML_SCALAR_NODE && !IsNull(n))
    w->r->entry[i].value = strdup((const char *)n->data.scalar.value);
  if (n->type != YAML_MAPPING_NODE || n->data.mapping.pairs.start == n->data.mapping.pairs.top)
    return true;
  w->r->entry[i].map = true;
  return WalkMap(w, n, strlen(w->path) + 1, depth + 1, false);
}

static bool IsMerge(const yaml_node_t *key)
{
  return key->type == YAML_SCALAR_NODE && !strcmp((const char *)key->data.scalar.value, "<<");
}

/* Puts the key behind the path of its map, which ends at `parent`. */
static bool PathTo(Walk *w, const yaml_node_t *key, size_t parent)
{
  const char *text;

  if (key->type != YAML_SCALAR_NODE)
    return SayAt(w->r, LineOf(key), "a key is a word, not a list or a map");
  if (Fault(key))
    return SayAt(w->r, LineOf(key), Fault(key));
  text = (const char *)key->data.scalar.value;
  if (!isalpha((unsigned char)*text))
    return SayAt(w->r, LineOf(key), *text ? "a key must begin with a letter" : "a key is empty");
  if (strlen(text) + parent + 2 > PATH_LENGTH)
    return SayAt(w->r, LineOf(key), "the key is too long");
  if (parent)
    w->path[parent - 1] = '_';
  strcpy(w->path + parent, text);
  return true;
}

static bool WalkPair(Walk *w, const yaml_node_pair_t *pair, size_t parent, int depth, bool merged)
{
  const yaml_node_t *key = yaml_document_get_node(w->doc, pair->key);
  const Entry       *old;

  if (!PathTo(w, key, parent))
    return false;
  old = EntryFind(w->r, w->path);
  if (old && merged)
    return true;
  if (old) {
    ReaderError(w->r, w->path, NULL, "is given twice, on lines %d and %d", (int)old->line, (int)LineOf(key));
    return false;
  }
  return WalkValue(w, yaml_document_get_node(w->doc, pair->value), LineOf(key), depth);
}

/* <<: a map, or a list of maps of which the first wins. */
static bool WalkMerge(Walk *w, const yaml_node_t *n, size_t parent, int depth)
{
  if (n->type == YAML_MAPPING_NODE)
    return WalkMap(w, n, parent, depth + 1, true);
  if (n->type != YAML_SEQUENCE_NODE)
    return SayAt(w->r, LineOf(n), "what << merges must be a map, or a list of maps");
  for (const yaml_node_item_t *i = n->data.sequence.items.start; i < n->data.sequence.items.top; i++) {
    const yaml_node_t *map = yaml_document_get_node(w->doc, *i);

    if (map->type != YAML_MAPPING_NODE)
      return SayAt(w->r, LineOf(map), "what << merges must be a map, or a list of maps");
    if (!WalkMap(w, map, parent, depth + 1, true))
      return false;
  }
  return true;
}

static bool WalkMap(Walk *w, const yaml_node_t *map, size_t parent, int depth, bool merged)
{
  const yaml_node_pair_t *pair, *begin = map->data.mapping.pairs.start, *end = map->data.mapping.pairs.top;

  if (depth > DEPTH_MAX) /* an alias of what it is in has no end */
    return SayAt(w->r, LineOf(map), "is nested too deeply");
  if (Fault(map))
    return SayAt(w->r, LineOf(map), Fault(map));
  for (pair = begin; pair < end; pair++)
    if (!IsMerge(yaml_document_get_node(w->doc, pair->key)) && !WalkPair(w, pair, parent, depth, merged))
      return false;
  for (pair = begin; pair < end; pair++)
    if (IsMerge(yaml_document_get_node(w->doc, pair->key)) &&
        !WalkMerge(w, yaml_document_get_node(w->doc, pair->value), parent, depth))
      return false;
  return true;
}

static bool WalkRoot(Reader *r, yaml_document_t *doc)
{
  Walk               w    = {.r = r, .doc = doc};
  const yaml_node_t *root = yaml_document_get_root_node(doc);

  if (!root || root->type != YAML_MAPPING_NODE) {
    ReaderError(r, NULL, NULL, "is not a case: no lines 'key: value'");
    return false;
  }
  return WalkMap(&w, root, 0, 0, false);
}

bool ReaderParse(Reader *r, const char *text)
{
  yaml_parser_t   p;
  yaml_document_t doc;
  bool            ok;

  if (!EventsPass(r, text))
    return false;
  ParserStart(&p, text);
  ok = yaml_parser_load(&p, &doc);
  if (ok) {
    ok = WalkRoot(r, &doc);
    yaml_document_delete(&doc);
  } else
    SayUnreadable(r, &p, text);
  yaml_parser_delete(&p);
  return ok;
}
