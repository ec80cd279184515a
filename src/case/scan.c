/* scan: a walk over the text of a case before PETSc's YAML reader sees it.  It notes on which line each key stands (for
   messages and to find doubled keys, which PETSc overwrites silently), and refuses what a case has no use for and what
   could make the reader recurse without end: anchors, aliases, tags, merge keys, includes, block scalars. */
#include "case_private.h"
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#define DEPTH_MAX 16
#define PATH_LENGTH 256

typedef struct {
  int      column; /* of the keys of a block map; for flow: '[' or '{' */
  PetscInt line;
  size_t   path;  /* length of the parent's path, with its '_' */
  bool     inner; /* flow: a list in a list */
} Level;

typedef struct {
  Reader  *r;
  char    *text, *p, *bol; /* all, here, begin of this line */
  PetscInt line, last_key; /* last_key: line of the last key that may still take a value */
  Level    block[DEPTH_MAX], flow[DEPTH_MAX];
  int      nblock, nflow;
  char     path[PATH_LENGTH]; /* of the last key */
  bool     item;              /* just after the '-' of a list */
  bool     ok;
} Scan;

static bool ScanError(Scan *s, PetscInt line, const char *what)
{
  char where[32] = "";

  if (line)
    snprintf(where, sizeof where, "line %d", (int)line);
  ReaderError(s->r, where, NULL, "%s", what);
  s->ok = false;
  return false;
}

static bool IsBreak(char c)
{
  return c == 0 || c == '\n' || c == '\r';
}

static bool IsBlank(char c)
{
  return c == ' ' || c == '\t' || IsBreak(c);
}

/* Does ':' at q end a key? */
static bool IsKeyEnd(const Scan *s, const char *q, bool quoted)
{
  if (*q != ':')
    return false;
  if (IsBlank(q[1]))
    return true;
  return s->nflow && (quoted || strchr(",[]{}", q[1]));
}

static bool ScanKey(Scan *s, const char *begin, size_t len, int column)
{
  size_t  parent = 0;
  Reader *r      = s->r;
  Mark   *mark;

  if (s->nflow)
    parent = s->flow[s->nflow - 1].path;
  else {
    while (s->nblock && s->block[s->nblock - 1].column > column)
      s->nblock--;
    if (!s->nblock || s->block[s->nblock - 1].column < column) {
      if (s->nblock == DEPTH_MAX)
        return ScanError(s, s->line, "is nested too deeply");
      s->block[s->nblock].path     = s->nblock ? strlen(s->path) + 1 : 0;
      s->block[s->nblock++].column = column;
    }
    parent = s->block[s->nblock - 1].path;
  }
  if (len == 0 || len + parent + 2 > PATH_LENGTH)
    return ScanError(s, s->line, len ? "the key is too long" : "a key is empty");
  if (!isalpha((unsigned char)*begin))
    return ScanError(s, s->line, "a key must begin with a letter");
  if (parent)
    s->path[parent - 1] = '_';
  memcpy(s->path + parent, begin, len);
  s->path[parent + len] = 0;
  for (PetscInt i = 0; i < r->nmark; i++) {
    if (strcasecmp(r->mark[i].name, s->path))
      continue;
    ReaderError(r, s->path, NULL, "is given twice, on lines %d and %d", (int)r->mark[i].line, (int)s->line);
    return s->ok = false;
  }
  if (r->nmark >= 4096)
    return ScanError(s, s->line, "the file has too many keys");
  if (r->nmark % 64 == 0)
    r->mark = realloc(r->mark, (size_t)(r->nmark + 64) * sizeof *r->mark);
  mark         = r->mark + r->nmark++;
  mark->name   = strdup(s->path);
  mark->line   = s->line;
  mark->offset = !s->nflow && column == 0 ? (PetscInt)(s->bol - s->text) : -1;
  return true;
}

static bool ScanQuoted(Scan *s)
{
  const char quote = *s->p, *begin = s->p + 1, *end;
  PetscInt   line   = s->line;
  int        column = (int)(s->p - s->bol);

  for (s->p++; *s->p; s->p++) {
    if (quote == '"' && *s->p == '\\' && s->p[1])
      s->p++;
    else if (*s->p == quote) {
      if (quote == '\'' && s->p[1] == quote)
        s->p++;
      else
        break;
    }
    if (*s->p == '\n') {
      s->line++;
      s->bol = s->p + 1;
    }
  }
  if (!*s->p)
    return ScanError(s, line, "a quote is opened here and never closed");
  end = s->p++;
  while (*s->p == ' ')
    s->p++;
  if (!IsKeyEnd(s, s->p, true))
    return true;
  s->p++;
  return ScanKey(s, begin, (size_t)(end - begin), column);
}

static bool ScanPlain(Scan *s)
{
  const char *begin  = s->p, *end;
  int         column = (int)(s->p - s->bol);

  while (!IsBreak(*s->p)) {
    if (IsKeyEnd(s, s->p, false))
      break;
    if (*s->p == '#' && IsBlank(s->p[-1]))
      break;
    if (s->nflow && strchr(",[]{}", *s->p))
      break;
    s->p++;
  }
  for (end = s->p; end > begin && IsBlank(end[-1]); end--) {
  }
  if (*s->p != ':')
    return true;
  s->p++;
  return ScanKey(s, begin, (size_t)(end - begin), column);
}

/* In a list in a list? */
static bool Inner(const Scan *s)
{
  return s->nflow && s->flow[s->nflow - 1].inner;
}

static bool ScanBracket(Scan *s)
{
  const bool in_list = s->nflow ? s->flow[s->nflow - 1].column == '[' : s->item;
  char       open;

  switch (*s->p) {
  case '[':
  case '{':
    if (s->nflow == DEPTH_MAX)
      return ScanError(s, s->line, "brackets are nested too deeply");
    s->flow[s->nflow].path   = strlen(s->path) ? strlen(s->path) + 1 : 0;
    s->flow[s->nflow].line   = s->line;
    s->flow[s->nflow].column = *s->p;
    s->flow[s->nflow].inner  = in_list && *s->p == '[';
    s->nflow++;
    if (Inner(s))
      *s->p = ' ';
    break;
  default:
    open = *s->p == ']' ? '[' : '{';
    if (!s->nflow || s->flow[s->nflow - 1].column != open)
      return ScanError(s, s->line, "a closing bracket has no partner");
    if (Inner(s))
      *s->p = ' ';
    s->nflow--;
    if (s->flow[s->nflow].path)
      s->path[s->flow[s->nflow].path - 1] = 0; /* back to the parent */
  }
  s->p++;
  return true;
}

/* At the begin of a line: indentation and document marks. */
static bool ScanLineStart(Scan *s)
{
  const char *q = s->p;

  s->bol = s->p;
  if (s->nflow)
    return true;
  while (*q == ' ')
    q++;
  if (*q == '\t') {
    while (*q == ' ' || *q == '\t')
      q++;
    if (!IsBreak(*q) && *q != '#')
      return ScanError(s, s->line, "is indented with a tab; YAML wants spaces");
  }
  if (*s->p == '%')
    return ScanError(s, s->line, "YAML directives are not allowed in a case");
  if (!strncmp(s->p, "---", 3) || !strncmp(s->p, "...", 3))
    return ScanError(s, s->line, "a case is one document without '---' or '...'");
  return true;
}

static bool ScanToken(Scan *s)
{
  const bool item = s->item && *s->p == '[';

  s->item = item || (*s->p == '-' && !s->nflow && IsBlank(s->p[1]));
  switch (*s->p) {
  case '\'':
  case '"':
    if (Inner(s))
      return ScanError(s, s->line, "a list in a list holds quantities without quotes");
    return ScanQuoted(s);
  case '[':
  case ']':
  case '{':
  case '}':
    return ScanBracket(s);
  case ',':
    if (Inner(s))
      *s->p = ';';
    s->p++;
    return true;
  case '&':
  case '*':
  case '!':
    return ScanError(s, s->line, "anchors (&), aliases (*) and tags (!) are not allowed in a case");
  case '|':
  case '>':
    return ScanError(s, s->line, "block texts (| and >) are not allowed in a case");
  case '%':
  case '@':
  case '`':
    return ScanError(s, s->line, "a value cannot begin with %, @ or `; put it in quotes");
  case '?':
  case '-':
    if (IsBlank(s->p[1])) {
      if (*s->p == '?')
        return ScanError(s, s->line, "'?' keys are not allowed in a case");
      s->p++;
      return true;
    }
    return ScanPlain(s);
  default:
    return ScanPlain(s);
  }
}

bool ReaderScan(Reader *r, char *text)
{
  Scan s = {.r = r, .text = text, .p = text, .bol = text, .line = 1, .ok = true};

  for (const char *p = text; *p; p++)
    if (((unsigned char)*p < 0x20 && !strchr("\t\n\r", *p)) || *p == 0x7f)
      return ScanError(&s, 0, "holds a control character; it is not a text file");
  if (strstr(text, "<<") || strstr(text, "$$"))
    return ScanError(&s, 0, "merge keys (<<) and $$ keys are not allowed in a case");
  if (!ScanLineStart(&s))
    return false;
  while (*s.p && s.ok) {
    if (*s.p == '\n') {
      s.p++;
      s.line++;
      ScanLineStart(&s);
    } else if (IsBlank(*s.p))
      s.p++;
    else if (*s.p == '#' && (s.p == text || IsBlank(s.p[-1])))
      for (; !IsBreak(*s.p); s.p++)
        *s.p = Inner(&s) ? ' ' : *s.p;
    else
      ScanToken(&s);
  }
  if (s.ok && s.nflow)
    return ScanError(&s, s.flow[s.nflow - 1].line, "a bracket is opened here and never closed");
  return s.ok;
}
