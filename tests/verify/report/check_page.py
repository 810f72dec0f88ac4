"""Judges pages of --report: check_page.py [--pictures N] [--has TEXT]... FILE. Exit 1 with the reasons where a page is not sound.

A page is one file: no element or style refers to anything outside it, no script runs, every element that is opened is closed
in its turn, identifiers are there once and links lead to them, pictures have texts, the file has at most 3 MB.
"""
import argparse
import base64
import html.parser
import re
import sys

VOID = {'meta', 'img', 'br', 'hr', 'wbr', 'link', 'input', 'circle', 'path'}
MOST_BYTES = 3000000


class Judge(html.parser.HTMLParser):
    def __init__(self):
        super().__init__(convert_charrefs=True)
        self.open, self.faults, self.ids, self.links, self.tags = [], [], [], [], set()
        self.pictures, self.text, self.cells, self.rows, self.divs = [], [], 0, [], []

    def fault(self, text):
        self.faults.append('line %d: %s' % (self.getpos()[0], text))

    def handle_starttag(self, tag, attributes):
        self.tags.add(tag)
        known = dict(attributes)
        if len(known) < len(attributes):
            self.fault('an attribute twice in ' + tag)
        if tag in ('script', 'link', 'iframe', 'object', 'embed', 'base', 'form'):
            self.fault('element ' + tag)
        for name, value in attributes:
            if name.startswith('on'):
                self.fault('script in attribute ' + name)
            if name in ('src', 'href', 'srcset', 'data', 'action', 'poster', 'background', 'xlink:href'):
                self.refer(tag, name, value or '')
        if 'id' in known:
            self.ids.append(known['id'])
        if tag == 'img':
            self.picture(known)
        if tag == 'svg' and not known.get('aria-label'):
            self.fault('svg without words')
        if tag == 'div':
            self.divs.append(known.get('class'))
        if tag == 'table':
            self.rows.append([])
            if 'scroll' not in self.divs:
                self.fault('a table that is cut where the screen is narrow')
        if tag == 'h3' and 'whole' not in self.divs:
            self.fault('a heading that may be parted from its table')
        if tag == 'tr':
            self.cells = 0
        if tag in ('td', 'th'):
            self.cells += 1
        if tag not in VOID:
            self.open.append(tag)

    def refer(self, tag, name, value):
        if name == 'href' and value.startswith('#'):
            self.links.append(value[1:])
        elif not (tag == 'img' and name == 'src' and value.startswith('data:image/')):
            self.fault('%s of %s refers to %s' % (name, tag, value[:60]))

    def picture(self, known):
        if not (known.get('alt') or '').strip():
            self.fault('img without alt')
        kind, _, code = (known.get('src') or '').partition(';base64,')
        data = base64.b64decode(code, validate=True)
        begins = {'data:image/png': b'\x89PNG\r\n\x1a\n', 'data:image/gif': b'GIF8', 'data:image/svg+xml': b'<?xml'}
        if not data.startswith(begins.get(kind, b'?')):
            self.fault('%s begins with %r' % (kind, data[:8]))
        ends = {'data:image/png': b'IEND\xaeB`\x82', 'data:image/gif': b';', 'data:image/svg+xml': b'</svg>\n\n'}
        if not data.rstrip(b'\n').endswith(ends.get(kind, b'').rstrip(b'\n')):
            self.fault('%s is cut' % kind)
        self.pictures.append(kind)

    def handle_endtag(self, tag):
        if tag in VOID:
            if tag in ('circle', 'path'):
                return
            self.fault('end of ' + tag)
            return
        if tag == 'div' and self.divs:
            self.divs.pop()
        if tag == 'tr':
            self.rows[-1].append(self.cells)
        if tag == 'table' and len(set(self.rows.pop())) > 1:
            self.fault('rows of a table with different numbers of cells')
        if not self.open or self.open[-1] != tag:
            self.fault('end of %s within %s' % (tag, self.open[-1:]))
        else:
            self.open.pop()

    def handle_data(self, data):
        if self.open and self.open[-1] == 'style':
            if 'url(' in data or '@import' in data:
                self.fault('the style refers to something')
        else:
            self.text.append(data)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('--pictures', type=int)
    parser.add_argument('--has', action='append', default=[])
    parser.add_argument('file')
    asked = parser.parse_args()
    raw = open(asked.file, 'rb').read()
    judge = Judge()
    if len(raw) > MOST_BYTES:
        judge.faults.append('%d bytes' % len(raw))
    try:
        page = raw.decode('utf-8')
    except UnicodeDecodeError as trouble:
        judge.faults.append('no UTF-8: %s' % trouble)
        page = raw.decode('utf-8', 'replace')
    bare = re.sub(r'base64,[^"]*', '', page)
    if re.search('[\x00-\x08\x0b-\x1f\x7f-\x9f]', bare):
        judge.faults.append('a control character')
    if re.search(r'&(?!(amp|lt|gt|quot|#\d+);)', bare):
        judge.faults.append('a bare &')
    if not page.startswith('<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'):
        judge.faults.append('it begins with ' + page[:60])
    judge.feed(page)
    judge.close()
    if judge.open:
        judge.faults.append('not closed: %s' % judge.open)
    if len(set(judge.ids)) < len(judge.ids):
        judge.faults.append('an id twice')
    judge.faults += ['no place for the link #' + link for link in judge.links if link not in judge.ids]
    for tag in ('title', 'h1', 'main', 'style'):
        if tag not in judge.tags:
            judge.faults.append('no ' + tag)
    if asked.pictures is not None and len(judge.pictures) != asked.pictures:
        judge.faults.append('%d pictures, expected %d' % (len(judge.pictures), asked.pictures))
    text = re.sub(r'\s+', ' ', ''.join(judge.text))
    judge.faults += ['not found: ' + part for part in asked.has if part not in text]
    print('%s: %d bytes, %d pictures, %d faults' % (asked.file, len(raw), len(judge.pictures), len(judge.faults)))
    for fault in judge.faults:
        print('   ' + fault)
    sys.exit(1 if judge.faults else 0)


main()
