    // Host: bytes out, bytes in.
    localparam real UART_BIT_NS = {{ uart_bit_ns }};
    reg uart_to_card;
    wire uart_from_card;
    reg [7:0] inbox [0:1023];
    integer received;
    reg [7:0] shift;
    integer bit_number;

    task host_idle;
        begin
            uart_to_card = 1'b1;
            received = 0;
        end
    endtask

    always @(negedge uart_from_card) begin
        #(UART_BIT_NS / 2.0);
        for (bit_number = 0; bit_number < 8; bit_number = bit_number + 1) begin
            #(UART_BIT_NS);
            shift = {uart_from_card, shift[7:1]};
        end
        #(UART_BIT_NS);
        if (uart_from_card !== 1'b1)
            complain("stop bit of the UART", {47'd0, uart_from_card}, 48'd1);
        inbox[received[9:0]] = shift;
        received = received + 1;
    end

    task send_byte(input [7:0] value);
        integer k;
        begin
            uart_to_card = 1'b0;
            #(UART_BIT_NS);
            for (k = 0; k < 8; k = k + 1) begin
                uart_to_card = value[k];
                #(UART_BIT_NS);
            end
            uart_to_card = 1'b1;
            #(UART_BIT_NS);
        end
    endtask

    task send_word(input [31:0] value);
        begin
            send_byte(value[31:24]);
            send_byte(value[23:16]);
            send_byte(value[15:8]);
            send_byte(value[7:0]);
        end
    endtask

    task send_command(input [7:0] command, input integer words, input [31:0] address);
        begin
            send_byte(command);
            send_byte(words[7:0]);
            send_word(address);
        end
    endtask

    task bus_write;
        begin
            send_command(8'h01, 1, access_address);
            send_word(access_value);
        end
    endtask

    // Reads into the inbox; the answer has to come within twice its length on the line.
    task bus_read;
        integer k;
        begin
            received = 0;
            send_command(8'h02, access_words, access_address);
            for (k = 0; k < 80 * access_words + 400 && received < 4 * access_words; k = k + 1)
                #(UART_BIT_NS);
            if (received < 4 * access_words)
                complain("bytes of a UART answer", received, 4 * access_words);
        end
    endtask

{% if pushes %}
    // A card that pushes frames from the start: the one under way goes out, and one byte stands in front of the next answer.
    task stop_pushing;
        begin
            write_word(CARD_STREAM_CONTROL, 32'd0);
            #(UART_BIT_NS * {{ frame_bits }});
            read_words(CARD_ID, 1);
            #(UART_BIT_NS * 12.0);
            if (received != 5 || inbox[0] !== 8'hFF)
                complain("byte in front of the first answer", inbox[0], 48'hFF);
        end
    endtask

{% endif %}
    function [31:0] word(input integer index);
        word = {inbox[4 * index], inbox[4 * index + 1], inbox[4 * index + 2], inbox[4 * index + 3]};
    endfunction

    // The card believes that the line has rested for so many us.
    task set_pause(input [16:0] us);
        begin
            @(negedge clk);
            dut.u_bridge.idle_us = us;
        end
    endtask

    // Writes of several words without a pause, reads of 33 words, addresses beyond the map, a command that stops in the middle.
    task bus_limits;
        begin
            send_command(8'h01, 2, CARD_CONFIG_TRIGGER_PERIOD);
            send_word(32'h00345678);
            send_word(32'hA1B2C300);
            #(SETTLE_NS);
            read_words(CARD_CONFIG_TRIGGER_PERIOD, 2);
            check("first word of a write", word(0), 32'h00345678);
            check("second word of a write", word(1), 32'hA1B2C300);
            // Beyond the map nothing is written, and 0 is read.
            write_word(CARD_CONFIG_HOLD | 32'h00000800, 32'hFFFFFF00);
            write_word(CARD_CONFIG_HOLD | 32'h80000000, 32'hFFFFFF00);
            #(SETTLE_NS);
            read_words(CARD_CONFIG_HOLD, 1);
            check("word after writes beyond the map", word(0), 32'hA1B2C300);
            read_words(CARD_CONFIG_HOLD | 32'h00010000, 1);
            check("word beyond the map", word(0), 32'd0);
            if (level > 0) begin
                read_words(CARD_ID, 33);
                #(UART_BIT_NS * 20.0);
                check("bytes of 33 words", received, 132);
            end
            if (level > 0 && may_deposit) begin
                // A command that stops is forgotten after 100 ms, and not much before.
                $display("    set inside the card: dut.u_bridge.idle_us, almost 100 ms");
                received = 0;
                send_byte(8'h02);
                send_byte(8'h01);
                set_pause(17'd99_900);
                #(UART_BIT_NS * 10.0);
                send_byte(8'h00);
                send_byte(8'h00);
                send_byte(CARD_CONFIG_HOLD[15:8]);
                send_byte(CARD_CONFIG_HOLD[7:0]);
                #(UART_BIT_NS * 80.0);
                check("bytes after a pause of less than 100 ms", received, 4);
                check("word after a pause", word(0), 32'hA1B2C300);
                send_byte(8'h02);
                send_byte(8'h01);
                #(UART_BIT_NS * 10.0);
                set_pause(17'd99_998);
                #(10_000.0);
                read_words(CARD_CONFIG_HOLD, 1);
                check("word after a command that stopped", word(0), 32'hA1B2C300);
                // The last byte has no stop bit: the card writes nothing, and ignores all bytes until the line has rested for 100 ms.
                send_command(8'h01, 1, CARD_CONFIG_TRIGGER_PERIOD);
                send_byte(8'h00);
                send_byte(8'h12);
                send_byte(8'h34);
                uart_to_card = 1'b0;
                #(UART_BIT_NS * 10.0);
                uart_to_card = 1'b1;
                #(UART_BIT_NS * 10.0);
                set_pause(17'd99_998);
                #(10_000.0);
                read_words(CARD_CONFIG_TRIGGER_PERIOD, 1);
                check("word after a byte without its stop bit", word(0), 32'h00345678);
            end
            write_word(CARD_CONFIG_HOLD, 32'd0);
            #(SETTLE_NS);
        end
    endtask
