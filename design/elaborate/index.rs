//! Index expressions such as `2*i+1`, which rust-hdl hands over as text.

/// The value of an integer expression of `+ - * / %`, parentheses, literals and loop variables.
pub(super) fn evaluate(text: &str, variables: &[(String, usize)]) -> Option<usize> {
    let mut parser = Parser {
        rest: text.trim_start(),
        variables,
    };
    let value = parser.sum()?;
    parser.rest.is_empty().then_some(value)
}

struct Parser<'a> {
    rest: &'a str,
    variables: &'a [(String, usize)],
}

impl Parser<'_> {
    fn take(&mut self, operators: &[char]) -> Option<char> {
        let c = self.rest.chars().next().filter(|c| operators.contains(c))?;
        self.rest = self.rest[c.len_utf8()..].trim_start();
        Some(c)
    }

    fn sum(&mut self) -> Option<usize> {
        let mut value = self.product()?;
        while let Some(operator) = self.take(&['+', '-']) {
            let right = self.product()?;
            value = match operator {
                '+' => value.checked_add(right)?,
                _ => value.checked_sub(right)?,
            };
        }
        Some(value)
    }

    fn product(&mut self) -> Option<usize> {
        let mut value = self.factor()?;
        while let Some(operator) = self.take(&['*', '/', '%']) {
            let right = self.factor()?;
            value = match operator {
                '*' => value.checked_mul(right)?,
                '/' => value.checked_div(right)?,
                _ => value.checked_rem(right)?,
            };
        }
        Some(value)
    }

    fn factor(&mut self) -> Option<usize> {
        if self.take(&['(']).is_some() {
            let value = self.sum()?;
            return self.take(&[')']).map(|_| value);
        }
        let end = self
            .rest
            .find(|c: char| !c.is_alphanumeric() && c != '_')
            .unwrap_or(self.rest.len());
        let (word, rest) = self.rest.split_at(end);
        self.rest = rest.trim_start();
        if let Some((_, value)) = self.variables.iter().rev().find(|(name, _)| name == word) {
            return Some(*value);
        }
        word.trim_end_matches("usize").replace('_', "").parse().ok()
    }
}

#[cfg(test)]
mod tests {
    use super::evaluate;

    #[test]
    fn index_expressions_follow_rusts_precedence() {
        let variables = [("i".to_string(), 5), ("j".to_string(), 2)];
        let value = |text| evaluate(text, &variables);
        assert_eq!(value("i"), Some(5));
        assert_eq!(value("(i+1)*j-3"), Some(9));
        assert_eq!(value("i+1*j"), Some(7));
        assert_eq!(value("7 % i / 2"), Some(1));
        assert_eq!(value("1-i"), None);
        assert_eq!(value("n-1"), None);
        assert_eq!(value("i+"), None);
    }
}
