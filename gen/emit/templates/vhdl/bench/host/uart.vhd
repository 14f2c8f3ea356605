{% if part == "signals" %}
    -- The host: a UART, 8 bits, no parity, in the UARTBone format.
    constant UART_BIT : time := CYCLE * (real(CONFIGURED_HZ) / {{ baud }}.0);
    signal uart_to_card : std_logic := '1';
    signal uart_from_card : std_logic;
    type byte_vector is array (natural range <>) of std_logic_vector(7 downto 0);
    -- Bytes that have come, at their number modulo the size.
    signal inbox : byte_vector(0 to 1023);
    signal received : natural := 0;
    signal bad_stop_bits : natural := 0;
{% elif part == "processes" %}

    uart_receiver : process
        variable byte : std_logic_vector(7 downto 0);
    begin
        wait until falling_edge(uart_from_card);
        wait for UART_BIT / 2;
        for n in 0 to 7 loop
            wait for UART_BIT;
            byte := uart_from_card & byte(7 downto 1);
        end loop;
        wait for UART_BIT;
        if uart_from_card /= '1' then
            bad_stop_bits <= bad_stop_bits + 1;
        end if;
        inbox(received mod 1024) <= byte;
        received <= received + 1;
    end process;
{% elif part == "procedures" %}
        procedure send (bytes : std_logic_vector) is
            alias bits : std_logic_vector(bytes'length - 1 downto 0) is bytes;
        begin
            for number in bits'length / 8 - 1 downto 0 loop
                uart_to_card <= '0';
                wait for UART_BIT;
                for n in 0 to 7 loop
                    uart_to_card <= bits(8 * number + n);
                    wait for UART_BIT;
                end loop;
                uart_to_card <= '1';
                wait for UART_BIT;
            end loop;
        end procedure;

        procedure write_word (address : natural; value : word_t) is
        begin
            send(x"0101" & bits_of(address, 32) & value);
        end procedure;

        -- The answer has to come within twice its length on the line; bytes in front of it are skipped.
        procedure read_words (address : natural; count : positive; skipped : natural := 0) is
            variable from : natural;
        begin
            from := received;
            send(x"02" & bits_of(count, 8) & bits_of(address, 32));
            for n in 1 to 80 * count + 400 loop
                exit when received >= from + skipped + 4 * count;
                wait for UART_BIT;
            end loop;
            -- Nothing comes behind it.
            wait for 12 * UART_BIT;
            check("bytes of a UART answer", received - from, skipped + 4 * count);
            check("stop bits of the UART that are LOW", bad_stop_bits, 0);
            from := from + skipped;
            for n in 0 to count - 1 loop
                words(n) := inbox((from + 4 * n) mod 1024) & inbox((from + 4 * n + 1) mod 1024)
                    & inbox((from + 4 * n + 2) mod 1024) & inbox((from + 4 * n + 3) mod 1024);
            end loop;
        end procedure;
{% if pushes %}

        -- The card sends frames of its stream after a reset: the one under way goes out, and one byte precedes the next answer.
        procedure stop_pushing is
        begin
            write_word(CARD_STREAM_CONTROL, x"00000000");
            wait for {{ frame_bits }} * UART_BIT;
            read_words(CARD_ID, 1, skipped => 1);
        end procedure;
{% endif %}
{% elif part == "steps" %}
        tell("bus: a command of several words");
        read_words(CARD_ID, IDENTIFICATION'length);
        check("last word of a long answer", words(IDENTIFICATION'length - 1), IDENTIFICATION(IDENTIFICATION'length - 1));

{% endif %}
