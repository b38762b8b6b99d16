// What a page can say of itself. Each function of `check` returns complaints, as sentences; an empty list is a page in
// order. report_check.py runs them under the conditions they are meant for: a width, a colour scheme, a medium.
(() => {
  const kDrawn = 'path, use, image, rect, circle, ellipse, line, polyline, polygon';
  const kUndrawn = 'defs, symbol, marker, clipPath, mask, pattern, filter';

  const shown = (element) => element.checkVisibility({visibilityProperty: true, opacityProperty: true});
  const words = (element) => element.textContent.replace(/\s+/g, ' ').trim();
  const brief = (text) => (text.length > 40 ? text.slice(0, 40) + '…' : text);
  const list = (selector, root = document) => [...root.querySelectorAll(selector)];

  function name_of(figure) {
    const title = figure.querySelector('h2, h3, h4, figcaption');
    const id = figure.id ? ` (#${figure.id})` : '';
    return title && words(title) ? `figure '${brief(words(title))}'${id}` : `figure ${figure.id || 'without a name'}`;
  }

  function name_of_element(element) {
    const figure = element.closest('figure');
    const text = brief(words(element));
    return `<${element.localName}>${text ? ` '${text}'` : ''}${figure ? ` in ${name_of(figure)}` : ''}`;
  }

  const apart = (a, b, slack = 0) =>
    a.right <= b.left + slack || b.right <= a.left + slack || a.bottom <= b.top + slack || b.bottom <= a.top + slack;
  const within = (inner, outer, slack = 1) =>
    inner.left >= outer.left - slack && inner.right <= outer.right + slack &&
    inner.top >= outer.top - slack && inner.bottom <= outer.bottom + slack;
  const is_finite = (box) => [box.left, box.top, box.right, box.bottom].every(Number.isFinite);

  // --- Colours ---

  const canvas = new OffscreenCanvas(1, 1).getContext('2d', {willReadFrequently: true});
  const known_colours = new Map();  // a page has few, on thousands of shapes
  function rgba(colour) {
    if (!known_colours.has(colour)) {
      canvas.clearRect(0, 0, 1, 1);
      canvas.fillStyle = colour;
      canvas.fillRect(0, 0, 1, 1);
      known_colours.set(colour, [...canvas.getImageData(0, 0, 1, 1).data]);
    }
    return known_colours.get(colour);
  }
  // Relative luminance and contrast as the Web Content Accessibility Guidelines define them.
  function luminance([r, g, b]) {
    const linear = (c) => (c /= 255, c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);
    return 0.2126 * linear(r) + 0.7152 * linear(g) + 0.0722 * linear(b);
  }
  function contrast(a, b) {
    const [high, low] = [luminance(rgba(a)), luminance(rgba(b))].sort((x, y) => y - x);
    return (high + 0.05) / (low + 0.05);
  }

  // The rectangle that fills a figure, if there is one.
  const known_sheets = new Map();
  function sheet_of(svg) {
    if (!known_sheets.has(svg)) {
      const all = svg.getBoundingClientRect();
      const fills = (rect) => is_painted(getComputedStyle(rect).fill) && within(all, rect.getBoundingClientRect(), 2);
      known_sheets.set(svg, list('rect', svg).find((rect) => !rect.closest(kUndrawn) && fills(rect)));
    }
    return known_sheets.get(svg);
  }

  // Of the nearest thing behind an element that is painted: in a figure, its sheet.
  function background_of(element) {
    const svg = element.closest('svg');
    const sheet = svg && sheet_of(svg);
    if (sheet) return getComputedStyle(sheet).fill;
    for (let at = element; at; at = at.parentElement) {
      const colour = getComputedStyle(at).backgroundColor;
      if (is_painted(colour)) return colour;
    }
    return 'Canvas';
  }
  const is_painted = (paint) => paint !== 'none' && (paint.startsWith('url') || rgba(paint)[3] > 0);
  const has_paint = (style) =>
    is_painted(style.fill) || (is_painted(style.stroke) && parseFloat(style.strokeWidth) > 0);

  // --- What is drawn in a figure ---

  // Gnuplot groups what belongs to the data; elsewhere a line along an axis, and a sheet behind all, are no marks.
  function marks_of(svg) {
    const plots = list('g[id*="gnuplot_plot_"]', svg);
    const keys = plots.flatMap((plot) => list('text', plot)).map((text) => text.getBoundingClientRect());
    const shapes = (plots.length > 0 ? plots : [svg]).flatMap((root) => list(kDrawn, root));
    return shapes.filter((shape) => {
      if (shape.closest(kUndrawn) || !shown(shape) || !has_paint(getComputedStyle(shape))) return false;
      const box = shape.getBoundingClientRect();
      if (plots.length > 0) return !keys.some((key) => is_key_sample(box, key));
      const along_axis = box.width < 1.5 || box.height < 1.5;
      return !along_axis && !within(svg.getBoundingClientRect(), box);
    });
  }
  // Within the line of its words, and beside them.
  function is_key_sample(box, key) {
    const middle = (box.top + box.bottom) / 2;
    const gap = Math.max(key.left - box.right, box.left - key.right);
    return middle > key.top && middle < key.bottom && box.height < 1.5 * key.height && gap < 2 * key.height;
  }

  function mark_complaint(svg) {
    const places = ['d', 'transform', 'points', 'x', 'y', 'width', 'height'];
    const bad = list(`${kDrawn}, g`, svg).find((shape) =>
      places.some((key) => /nan|inf/i.test(shape.getAttribute(key) || '')));
    if (bad) return `has a <${bad.localName}> at no finite place`;
    const marks = marks_of(svg).map((shape) => shape.getBoundingClientRect());
    if (marks.some((box) => !is_finite(box))) return 'has marks at no finite place';
    const paper = svg.getBoundingClientRect();
    const shows = (box) => box.width + box.height > 0 && within(box, paper, 2);
    if (!marks.some(shows)) return 'shows axes at most: nothing is drawn';
    if (marks.some((box) => apart(box, paper))) return 'has marks outside its paper';
    return null;
  }

  function medium_complaint(medium) {
    const is_picture = medium.localName === 'img';
    if (is_picture && !(medium.complete && medium.naturalWidth > 0)) return 'holds a picture that did not load';
    const box = medium.getBoundingClientRect();
    if (!(box.width >= 50 && box.height >= 30)) return `is drawn ${box.width} by ${box.height} pixels large`;
    return is_picture ? null : mark_complaint(medium);
  }

  const media_of = (figure) => list('svg, img', figure).filter((medium) => !medium.parentElement.closest('svg'));

  // The words of a figure: not empty, not defined for later use.
  const labels_of = (figure) =>
    list('svg text', figure).filter((text) => words(text) && !text.closest(kUndrawn) && shown(text));

  function lettering_of(text) {
    const matrix = text.getScreenCTM();
    const scale = Math.sqrt(Math.abs(matrix.a * matrix.d - matrix.b * matrix.c));
    return scale * parseFloat(getComputedStyle(text).fontSize);
  }

  const check = {};

  check.figures_are_drawn = () => {
    const figures = list('figure');
    if (figures.length === 0) return ['the page has no figure'];
    return figures.filter(shown).flatMap((figure) => {
      const media = media_of(figure);
      if (media.length === 0) return [`${name_of(figure)} holds neither svg nor img`];
      return media.map(medium_complaint).filter(Boolean).map((complaint) => `${name_of(figure)} ${complaint}`);
    });
  };

  check.figures_have_names = () =>
    list('figure').flatMap((figure) => {
      const titled = list('h2, h3, h4, figcaption', figure).some((title) => words(title));
      const named = media_of(figure).every((medium) =>
        ['alt', 'aria-label', 'aria-labelledby'].some((key) => medium.getAttribute(key)) ||
        medium.querySelector(':scope > title'));
      return [titled ? null : `${name_of(figure)} has neither title nor caption`,
              named ? null : `${name_of(figure)} has no name for those who cannot see it`].filter(Boolean);
    });

  check.lettering_can_be_read = (least) =>
    list('figure').flatMap((figure) => {
      const labels = labels_of(figure);
      const paper = media_of(figure).map((medium) => medium.getBoundingClientRect());
      const small = labels.find((text) => lettering_of(text) < least);
      const cut = labels.find((text) => !paper.some((sheet) => within(text.getBoundingClientRect(), sheet, 0.5)));
      const name = name_of(figure);
      return [small ? `${name} has lettering of ${lettering_of(small).toFixed(1)} px: '${brief(words(small))}'` : null,
              cut ? `${name} cuts off '${brief(words(cut))}'` : null,
              overlap_complaint(figure, labels)].filter(Boolean);
    });

  function overlap_complaint(figure, labels) {
    const boxes = labels.map((text) => text.getBoundingClientRect());
    for (let i = 0; i < boxes.length; ++i) {
      for (let j = 0; j < i; ++j) {
        // The box of a line of text reaches above and below its letters.
        if (apart(boxes[i], boxes[j], 0.2 * Math.min(boxes[i].height, boxes[i].width))) continue;
        return `${name_of(figure)}: '${brief(words(labels[j]))}' and '${brief(words(labels[i]))}' run into one another`;
      }
    }
    return null;
  }

  check.fits = (width) => {
    const laid_out = document.documentElement.clientWidth, needed = document.documentElement.scrollWidth;
    if (laid_out !== width) return [`is laid out ${laid_out} px wide on a screen of ${width} px: it names no viewport`];
    // Of what sticks out, the innermost; what scrolls in a box of its own does not stick out.
    const scrolls = (element) => ['auto', 'scroll'].includes(getComputedStyle(element).overflowX);
    const in_scroller = (element) => {
      for (let at = element.parentElement; at !== document.body; at = at.parentElement) if (scrolls(at)) return true;
      return false;
    };
    const sticks_out = (element) =>
      element.getBoundingClientRect().right > width + 1 && shown(element) && !in_scroller(element);
    const culprits = list('body *').filter((element) => !element.ownerSVGElement && sticks_out(element));
    const holds_other = (element) => culprits.some((other) => other !== element && element.contains(other));
    const inmost = culprits.filter((element) => !holds_other(element));
    const named = inmost.slice(0, 3).map((element) =>
      `${name_of_element(element)} reaches to ${Math.ceil(element.getBoundingClientRect().right)} px`);
    return named.length > 0 || needed <= width ? named : [`needs ${needed} px`];
  };

  check.figures_stand_apart = () => {
    const figures = list('figure').filter(shown);
    const boxes = figures.map((figure) => figure.getBoundingClientRect());
    for (let i = 0; i < figures.length; ++i) {
      for (let j = 0; j < i; ++j) {
        if (!apart(boxes[i], boxes[j], 1)) return [`${name_of(figures[j])} and ${name_of(figures[i])} overlap`];
      }
    }
    return [];
  };

  // --- What a reader finds first, and what is folded ---

  check.chapters_open_with_a_verdict = () =>
    list('section.scene').flatMap((chapter) => {
      const [title, first] = chapter.children;
      const name = `the chapter '${brief(words(title))}'`;
      if (!first || !first.matches('p.verdict') || !words(first)) return [`${name} does not open with a verdict`];
      // A sentence ends with a full stop before a capital, or at the end.
      const sentences = words(first).split(/[.?!] (?=[A-Z])/).length;
      return sentences === 1 && /[.?!]$/.test(words(first)) ? [] :
        [`${name} opens with ${sentences} sentences instead of one`];
    });

  check.is_no_taller = (most) => {
    const height = document.documentElement.scrollHeight;
    return height <= most ? [] : [`the page is ${height} px tall, over ${most}`];
  };

  check.everything_is_unfolded = () =>
    list('details').flatMap((fold) => {
      const hidden = list(':scope > :not(summary)', fold).find((part) => !shown(part));
      return hidden ? [`the part '${brief(words(fold.querySelector('summary') || fold))}' is folded`] : [];
    });

  // A reader of a phone does not see that a table scrolls.
  check.no_column_is_cut = () =>
    list('table').filter(shown).flatMap((table) => {
      const frame = table.parentElement, needed = table.getBoundingClientRect().width;
      const cut = frame.scrollWidth > frame.clientWidth + 1 || needed > frame.clientWidth + 1;
      return cut ? [`the table '${brief(words(table.querySelector('th, td')))}' is cut: it needs ` +
                    `${Math.ceil(Math.max(needed, frame.scrollWidth))} px of ${frame.clientWidth}`] : [];
    });

  // Gnuplot draws marks as <use>. Those of the legend stand beside their words.
  check.no_mark_covers_a_label = () =>
    list('figure').filter(shown).flatMap((figure) => {
      const marks = list('svg use, svg circle', figure).filter((mark) => !mark.closest(kUndrawn) && shown(mark));
      const boxes = marks.map((mark) => mark.getBoundingClientRect());
      const covered = labels_of(figure).find((label) => {
        const box = label.getBoundingClientRect();
        return boxes.some((mark) => {
          const x = (mark.left + mark.right) / 2, y = (mark.top + mark.bottom) / 2;
          return x > box.left && x < box.right && y > box.top && y < box.bottom;
        });
      });
      return covered ? [`${name_of(figure)} draws a mark over '${brief(words(covered))}'`] : [];
    });

  check.running_text_is_large = (least) => {
    const size = parseFloat(getComputedStyle(document.body).fontSize);
    return size >= least ? [] : [`running text is ${size} px large`];
  };

  check.contrast_is_enough = (of_body, of_other, in_figures) => {
    const body = contrast(getComputedStyle(document.body).color, background_of(document.body));
    const complaints = body >= of_body ? [] : [`running text has a contrast of ${body.toFixed(1)}:1`];
    const seen = new Set();
    for (const element of list('body *')) {
      const own_words = [...element.childNodes].some((node) => node.nodeType === Node.TEXT_NODE && node.data.trim());
      if (!own_words || element.closest(`${kUndrawn}, title, script, style`) || !shown(element)) continue;
      const style = getComputedStyle(element);
      const ink = element.ownerSVGElement ? style.fill : style.color;
      const paper = background_of(element);
      const key = `${element.closest('figure') ? name_of(element.closest('figure')) : ''} ${ink} ${paper}`;
      if (seen.has(key)) continue;
      seen.add(key);
      const found = contrast(ink, paper);
      if (found >= (element.ownerSVGElement ? in_figures : of_other)) continue;
      complaints.push(`${name_of_element(element)} has a contrast of ${found.toFixed(1)}:1`);
    }
    return complaints;
  };

  // The lines of a plot, each taken by its strongest paint; a map has pale cells, but not only those.
  check.marks_are_told_from_paper = (least) =>
    list('figure svg').filter(shown).flatMap((svg) => {
      const groups = list('g[id*="gnuplot_plot_"]', svg);
      return groups.map((group) => {
        const paints = new Set(list(kDrawn, group).flatMap((shape) => {
          const style = getComputedStyle(shape);
          return [style.fill, style.stroke].filter((paint) => paint !== 'none' && !paint.startsWith('url'));
        }));
        const strongest = Math.max(0, ...[...paints].map((paint) => contrast(paint, background_of(svg))));
        const title = words(group.querySelector('text') || svg);
        return strongest >= least || paints.size === 0 ? null :
          `${name_of(svg.closest('figure'))} draws '${brief(title)}' with a contrast of ${strongest.toFixed(1)}:1`;
      }).filter(Boolean);
    });

  check.ids_are_unique = () => {
    const count = new Map();
    for (const element of list('[id]')) count.set(element.id, (count.get(element.id) || 0) + 1);
    return [...count].filter(([, times]) => times > 1).map(([id, times]) => `the id '${id}' is given ${times} times`);
  };

  check.references_resolve = () => {
    const linked = list('a[href^="#"], use').map((element) =>
      element.getAttribute('href') || element.getAttribute('xlink:href') || '');
    const paints = ['fill', 'stroke', 'clip-path', 'filter', 'mask'];
    const painted = list(paints.map((key) => `[${key}^="url(#"]`).join()).flatMap((element) =>
      paints.map((key) => /^url\((#[^)]+)/.exec(element.getAttribute(key) || '')?.[1]).filter(Boolean));
    const missing = [...new Set([...linked, ...painted])].filter((target) =>
      target !== '#' && target !== '#top' && !document.getElementById(decodeURIComponent(target.slice(1))));
    return missing.map((target) => `nothing on the page is called '${target}'`);
  };

  // A plain link may lead elsewhere; nothing else may.
  check.nothing_lies_outside = () => {
    const outside = (address) => /^\s*(https?:|ftp:|file:|\/\/)/i.test(address);
    const complaints = [];
    for (const element of list('*')) {
      for (const {name, value} of element.attributes) {
        const is_link = element.localName === 'a' && /^(xlink:)?href$/.test(name);
        const is_address = /^(xlink:href|href|src|srcset|data|poster|action|background)$/.test(name);
        if (!is_link && is_address && outside(value)) {
          complaints.push(`<${element.localName}> takes ${name} from ${value}`);
        }
        if (name === 'style' || /url\(/.test(value)) complaints.push(...style_complaints(value));
      }
    }
    for (const style of list('style')) complaints.push(...style_complaints(style.textContent));
    return complaints;
  };
  function style_complaints(text) {
    const imports = text.match(/@import[^;]*/g) || [];
    const addresses = (text.match(/url\([^)]*\)/g) || []).filter((address) => !/url\(\s*["']?(#|data:)/.test(address));
    return [...imports, ...addresses].map((found) => `a style refers to something else: ${brief(found)}`);
  }

  check.page_is_described = () =>
    [document.documentElement.lang ? null : 'the page does not say its language',
     document.title.trim() ? null : 'the page has no title'].filter(Boolean);

  window.report_check = check;
})();
