#!/usr/bin/python3
"""doc/mechanisms is what the derive tool writes today, and its formats are documents that their readers accept."""

import os
import re
import shutil
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree

import yaml
from data_support import ROOT

DERIVE = os.environ.get('SCREWLINE_DERIVE', os.path.join(ROOT, 'build', 'devel', 'lib', 'screwline', 'derive'))
PAGES = os.path.join(ROOT, 'doc', 'mechanisms')
NUMBER = re.compile(r'-?\d+\.\d')
ROUNDING = 0.15  # a coordinate of a drawing has one decimal


def derive(robot, *words, **options):
    command = [DERIVE, os.path.join(ROOT, 'urdf', robot + '.urdf')] + list(words)
    return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, **options)


def robots():
    return sorted(name[:-3] for name in os.listdir(PAGES) if name.endswith('.md'))


class Pages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp()
        subprocess.run([os.path.join(ROOT, 'scripts', 'mechanism_pages'), DERIVE, cls.folder], check=True)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def both(self, name):
        texts = []
        for folder in (PAGES, self.folder):
            with open(os.path.join(folder, name)) as stream:
                texts.append(stream.read())
        return texts

    def test_are_what_is_derived(self):
        self.assertEqual(sorted(os.listdir(PAGES)), sorted(os.listdir(self.folder)))
        for robot in robots():
            kept, written = self.both(robot + '.md')
            self.assertEqual(kept, written, robot + ': run scripts/mechanism_pages')

    def test_drawings_are_what_is_drawn(self):
        for robot in robots():
            kept, written = self.both(robot + '.svg')
            self.assertEqual(NUMBER.sub('', kept), NUMBER.sub('', written), robot + ': run scripts/mechanism_pages')
            for a, b in zip(NUMBER.findall(kept), NUMBER.findall(written)):
                self.assertLessEqual(abs(float(a) - float(b)), ROUNDING, robot)
            ElementTree.fromstring(kept)

    def test_tell_every_erratum(self):
        with open(os.path.join(ROOT, 'test', 'data', 'errata.yaml')) as stream:
            errata = [erratum['id'] for erratum in yaml.safe_load(stream)['errata']]
        told = ''.join(self.both(robot + '.md')[0] for robot in robots())
        self.assertGreater(len(errata), 60)
        for erratum in errata:
            self.assertIn('\n| {} |'.format(erratum), told)

    def test_name_what_each_condition_loses(self):
        for robot in robots():
            page = self.both(robot + '.md')[0]
            conditions = re.findall(r'^- .* Rank \d.*$', page, re.MULTILINE)
            self.assertTrue(conditions, robot)
            for condition in conditions:
                self.assertIn('Lost:', condition, robot)


class Tables(unittest.TestCase):
    TABLES = os.path.join(ROOT, 'config', 'dh')

    def derived(self, *words):
        run = subprocess.run([DERIVE] + list(words), stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        return run.returncode, run.stdout.decode(), run.stderr.decode()

    def determinant(self, file):
        code, document, _ = self.derived(file, '--format', 'text', '--quantities', 'determinant')
        self.assertEqual(code, 0, file)
        return re.findall(r'det J = .*', document)

    def test_have_the_determinant_of_their_urdf(self):
        with tempfile.TemporaryDirectory() as folder:
            urdf = os.path.join(folder, 'arm.urdf')
            for name in sorted(os.listdir(self.TABLES)):
                table = os.path.join(self.TABLES, name)
                with open(urdf, 'wb') as stream:
                    subprocess.run([os.path.join(os.path.dirname(DERIVE), 'dh_to_urdf'), table], stdout=stream, check=True)
                of_urdf = self.determinant(urdf)
                self.assertEqual(len(of_urdf), 1, name)
                self.assertEqual(self.determinant(table), of_urdf, name)

    def test_have_no_links_to_choose(self):
        code, document, error = self.derived(os.path.join(self.TABLES, 'two_link_lift.yaml'), '--base', 'world')
        self.assertEqual((code, document), (1, ''))
        self.assertIn('--base', error)


class Formats(unittest.TestCase):
    def test_html_needs_nothing_else(self):
        page = derive('puma560', '--format', 'html').stdout.decode()
        self.assertIn('<svg', page)
        self.assertFalse(re.search(r'src=|href=|@import|url\(', page))
        formulas = re.findall(r'<math.*?</math>', page, re.DOTALL)
        self.assertGreater(len(formulas), 40)
        for formula in formulas:
            ElementTree.fromstring(formula)
            self.assertFalse(re.search(r'[\\{}]', formula), formula)
        for drawing in re.findall(r'<svg.*?</svg>', page, re.DOTALL):
            ElementTree.fromstring(drawing)

    def test_pdf_says_what_it_needs(self):
        answer = derive('rr_planar', '--format', 'pdf', env={'PATH': '/nowhere'})
        self.assertEqual(answer.returncode, 1)
        self.assertIn(b'texlive-latex-base', answer.stderr)
        self.assertEqual(answer.stdout, b'')

    def test_unknown_format_is_refused(self):
        answer = derive('rr_planar', '--format', 'docx')
        self.assertEqual(answer.returncode, 1)
        self.assertIn(b"format is 'docx'", answer.stderr)

    @unittest.skipUnless(shutil.which('pdflatex'), 'pdflatex is not installed (texlive-latex-base)')
    def test_latex_compiles_and_stays_on_the_page(self):
        for robot in ('rr_planar', 'rrprrr', 'puma560'):
            with tempfile.TemporaryDirectory() as folder:
                with open(os.path.join(folder, 'report.tex'), 'wb') as stream:
                    stream.write(derive(robot, '--format', 'latex').stdout)
                run = subprocess.run(['pdflatex', '-interaction=nonstopmode', '-halt-on-error', 'report.tex'],
                                     cwd=folder, stdout=subprocess.PIPE)
                self.assertEqual(run.returncode, 0, run.stdout.decode(errors='replace')[-2000:])
                with open(os.path.join(folder, 'report.log'), errors='replace') as stream:
                    wide = [float(size) for size in re.findall(r'Overfull \\hbox \(([0-9.]+)pt', stream.read())]
                self.assertLess(max(wide, default=0.0), 10.0, robot)
        self.assertTrue(derive('rr_planar', '--format', 'pdf').stdout.startswith(b'%PDF'))


if __name__ == '__main__':
    unittest.main()
